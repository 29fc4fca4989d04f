// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The element kernel, with its hat bubble and closed forms, against the mini element with the polynomial
// bubble 256 l1 l2 l3 l4, assembled by quadrature through FEValues. Proved:
// - for a linear velocity field, any nodal pressures and a power law, the residuals of the nodes are the
// same, and those
//   of the bubbles are in the ratio of the bubbles' integrals, 32/105 to 1/4 of the volume; they vanish for a
//   constant pressure;
// - for a Newtonian flow with a body force the two solutions approach each other as h^2 in the velocity,
// faster than
//   h in the pressure.

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/full_matrix.h>

#include "../../verification/element/manufactured_flow.h"
#include "element_test_tools.h"

using namespace retroforge;

/// Continuous P1 and one bubble per tetrahedron.
class PolynomialBubble : public dealii::FE_SimplexPoly<3>
{
public:
  PolynomialBubble()
      : dealii::FE_SimplexPoly<3>(polynomials(),
                                  dealii::FiniteElementData<3>({1, 0, 0, 1},
                                                               dealii::ReferenceCells::Tetrahedron,
                                                               1,
                                                               4,
                                                               dealii::FiniteElementData<3>::H1),
#if DEAL_II_VERSION_GTE(9, 6, 0)
                                  false,
#endif
                                  cell_points(),
                                  std::vector<std::vector<dealii::Point<2>>>(4, face_points()),
                                  dealii::FullMatrix<double>())
  {
  }

  std::unique_ptr<dealii::FiniteElement<3>> clone() const override
  {
    return std::make_unique<PolynomialBubble>(*this);
  }

  std::string get_name() const override
  {
    return "PolynomialBubble";
  }

private:
  static dealii::BarycentricPolynomials<3> polynomials()
  {
    using Polynomial = dealii::BarycentricPolynomial<3>;
    std::vector<Polynomial> all;
    for (unsigned int a = 0; a < 4; ++a)
      all.push_back(Polynomial::monomial(a));
    all.push_back(256 * all[0] * all[1] * all[2] * all[3]);
    return all;
  }

  static std::vector<dealii::Point<2>> face_points()
  {
    return {{0., 0.}, {1., 0.}, {0., 1.}};
  }

  static std::vector<dealii::Point<3>> cell_points()
  {
    return {{0., 0., 0.}, {1., 0., 0.}, {0., 1., 0.}, {0., 0., 1.}, {0.25, 0.25, 0.25}};
  }
};

/// Cell by cell, what FEValues makes of the unknowns in the order of `flatten`.
class QuadratureElement
{
public:
  using Cell = std::vector<double>;

  explicit QuadratureElement(const TetMesh &mesh)
      : mapping_(dealii::FE_SimplexP<3>(1))
      , element_(PolynomialBubble(), 3, dealii::FE_SimplexP<3>(1), 1)
      , dofs_(triangulation_)
      , values_(mapping_,
                element_,
                dealii::QGaussSimplex<3>(4),
                dealii::update_values | dealii::update_gradients | dealii::update_quadrature_points |
                  dealii::update_JxW_values)
  {
    std::vector<dealii::Point<3>> vertices;
    for (const Vec3 &x : mesh.X)
      vertices.emplace_back(x);
    std::vector<dealii::CellData<3>> cells;
    for (const auto &nodes : mesh.cells)
    {
      cells.emplace_back(4);
      std::copy(nodes.begin(), nodes.end(), cells.back().vertices.begin());
    }
    triangulation_.create_triangulation(vertices, cells, {});
    dofs_.distribute_dofs(element_);
    for (const auto &cell : dofs_.active_cell_iterators())
      cells_.push_back(cell);
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      for (unsigned int a = 0; a < 4; ++a)
        AssertThrow(cells_[c]->vertex_index(a) == mesh.cells[c][a], dealii::ExcInternalError());
    for (unsigned int i = 0; i < 19; ++i)
    {
      const auto [component, shape] = element_.system_to_component_index(i);
      order_[i] = component == 3 ? 15 + shape : shape == 4 ? 12 + component : 3 * shape + component;
    }
  }

  Cell residual(const CellIndex c, const Cell &w, const NortonHoff<double> &law)
  {
    values_.reinit(cells_[c]);
    Cell r(19, 0.);
    for (const unsigned int q : values_.quadrature_point_indices())
    {
      dealii::SymmetricTensor<2, 3> eps;
      double                        p = 0.;
      for (unsigned int i = 0; i < 19; ++i)
      {
        eps += w[order_[i]] * values_[velocity_].symmetric_gradient(i, q);
        p += w[order_[i]] * values_[pressure_].value(i, q);
      }
      const auto stress = law(eps * eps) * eps;
      for (unsigned int i = 0; i < 19; ++i)
        r[order_[i]] +=
          (stress * values_[velocity_].symmetric_gradient(i, q) - p * values_[velocity_].divergence(i, q) -
           trace(eps) * values_[pressure_].value(i, q)) *
          values_.JxW(q);
    }
    return r;
  }

  Cell body_load(const CellIndex c, const ManufacturedFlow &flow)
  {
    values_.reinit(cells_[c]);
    Cell load(19, 0.);
    for (const unsigned int q : values_.quadrature_point_indices())
    {
      const Vec3 force = flow.body_force(values_.quadrature_point(q)) * values_.JxW(q);
      for (unsigned int i = 0; i < 19; ++i)
        load[order_[i]] += force * values_[velocity_].value(i, q);
    }
    return load;
  }

private:
  dealii::Triangulation<3>                                 triangulation_;
  dealii::MappingFE<3>                                     mapping_;
  dealii::FESystem<3>                                      element_;
  dealii::DoFHandler<3>                                    dofs_;
  dealii::FEValues<3>                                      values_;
  std::vector<dealii::DoFHandler<3>::active_cell_iterator> cells_;
  std::array<unsigned int, 19>                             order_;
  const dealii::FEValuesExtractors::Vector                 velocity_{0};
  const dealii::FEValuesExtractors::Scalar                 pressure_{3};
};

CellValues<double> unflatten(const std::vector<double> &x)
{
  CellValues<double> w;
  for (unsigned int a = 0; a < 4; ++a)
  {
    w.V[a] = Vec3({x[3 * a], x[3 * a + 1], x[3 * a + 2]});
    w.P[a] = x[15 + a];
  }
  w.beta = Vec3({x[12], x[13], x[14]});
  return w;
}

/// Residuals of a linear velocity field.
void compare_residuals(const double m)
{
  const TetMesh            mesh = unit_cube(0.3);
  const NortonHoff<double> law{1.7, m, 0.1};
  QuadratureElement        quadrature(mesh);
  Random                   random;
  Errors                   errors;
  const Vec3               v0 = random.vector();
  dealii::Tensor<2, 3>     L;
  for (unsigned int i = 0; i < 3; ++i)
    L[i] = random.vector();
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
  {
    CellValues<double> w = random.cell_values();
    for (unsigned int a = 0; a < 4; ++a)
      w.V[a] = v0 + L * mesh.X[mesh.cells[c][a]];
    w.beta = Vec3();
    Four<Vec3> X;
    for (unsigned int a = 0; a < 4; ++a)
      X[a] = mesh.X[mesh.cells[c][a]];
    const auto geometry = cell_geometry(X);
    const auto kernel   = flatten(cell_residual(geometry, w, law));
    const auto other    = quadrature.residual(c, flatten(w), law);
    const auto part     = [](const std::vector<double> &r, const unsigned int begin, const unsigned int end) {
      return std::vector<double>(r.begin() + begin, r.begin() + end);
    };
    errors.compare("momentum of the nodes", part(other, 0, 12), part(kernel, 0, 12));
    errors.compare("continuity", part(other, 15, 19), part(kernel, 15, 19));
    std::vector<double> bubble = part(kernel, 12, 15);
    for (double &x : bubble)
      x *= 128. / 105.;
    errors.compare("momentum of the bubbles, in ratio", part(other, 12, 15), bubble);

    w.P.fill(0.7);
    const double scale = 0.7 * geometry.volume * std::sqrt(geometry.g[0] * geometry.g[0]);
    errors.compare("hat at constant pressure", 1. + cell_residual(geometry, w, law).beta.norm() / scale, 1.);
    const auto constant = quadrature.residual(c, flatten(w), law);
    errors.compare("polynomial at constant pressure", 1. + unflatten(constant).beta.norm() / scale, 1.);
  }
  std::cout << "linear velocity field, m = " << m << std::endl;
  errors.print(1e-12);
}

/// Right-hand side and matrix of one cell before the bubble is condensed: residual is linear in the unknowns.
template <typename Residual>
CellSystem condense(const Residual &residual, const std::vector<double> &start, std::vector<double> rhs)
{
  dealii::FullMatrix<double> H(19, 19), bubble(3, 3), inverse(3, 3);
  for (unsigned int s = 0; s < 19; ++s)
  {
    std::vector<double> unit(19, 0.);
    unit[s]           = 1.;
    const auto column = residual(unit);
    for (unsigned int r = 0; r < 19; ++r)
    {
      H(r, s) = column[r];
      rhs[r] -= column[r] * start[s];
    }
  }
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j)
      bubble(i, j) = H(12 + i, 12 + j);
  inverse.invert(bubble);
  CellSystem system(4);
  const auto nodal = [](const unsigned int k) { return k < 12 ? k : k + 3; };
  for (unsigned int r = 0; r < 16; ++r)
  {
    system.rhs[r] = rhs[nodal(r)];
    for (unsigned int s = 0; s < 16; ++s)
      system.matrix(r, s) = H(nodal(r), nodal(s));
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
      {
        const double factor = H(nodal(r), 12 + i) * inverse(i, j);
        system.rhs[r] -= factor * rhs[12 + j];
        for (unsigned int s = 0; s < 16; ++s)
          system.matrix(r, s) -= factor * H(12 + j, nodal(s));
      }
  }
  return system;
}

/// Nodal corrections of the interpolated flow by either element; differences of their solutions in v and p.
struct Differences
{
  double h, v, p;
};

Differences solution_differences(const double element_size)
{
  const std::string       free_patch = "side +x";
  const ManufacturedFlow  flow{{1., 1., 0.}};
  const TetMesh           mesh = unit_cube(element_size);
  const Discretization<3> discretization(mesh, {ElementPair::mini}, MPI_COMM_SELF);
  const auto              start    = flow.interpolant(mesh, discretization);
  const auto              traction = flow.traction_load(mesh, discretization, free_patch);
  const auto              points   = sub_cell_points();
  QuadratureElement       quadrature(mesh);
  const Unknowns          unknowns(discretization);
  GlobalSystem            system(mesh, unknowns, held_velocities(mesh, discretization, free_patch));

  const auto solve = [&](const auto &cell_system) {
    NodalVectors<double> boundary = traction;
    system.assemble([&](const CellIndex c) {
      CellSystem cell = cell_system(c);
      for (unsigned int a = 0; a < 4; ++a)
      {
        Vec3 &force = boundary[mesh.cells[c][a]]; // given to the node's first cell
        for (unsigned int i = 0; i < 3; ++i)
          cell.rhs[3 * a + i] += force[i];
        force = Vec3();
      }
      return cell;
    });
    return system.solve();
  };
  const std::vector<double> hat        = solve([&](const CellIndex c) {
    const auto X        = positions_of_cell(discretization, mesh.X, c);
    const auto geometry = cell_geometry(X);
    return condense([&](const auto &w) { return flatten(cell_residual(geometry, unflatten(w), flow.law)); },
                    flatten(MiniPair::on_cell(discretization, start, c)),
                    flatten(flow.body_load(MiniPair(), points, X)));
  });
  const std::vector<double> polynomial = solve([&](const CellIndex c) {
    return condense([&](const auto &w) { return quadrature.residual(c, w, flow.law); },
                    flatten(MiniPair::on_cell(discretization, start, c)),
                    quadrature.body_load(c, flow));
  });

  Differences differences{mean_edge(mesh), 0., 0.};
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
  {
    const double volume = geometry_of_cell(discretization, mesh.X, c).volume;
    for (const SubCellPoint &point : points)
      for (unsigned int i = 0; i < 4; ++i)
      {
        double d = 0.;
        for (unsigned int a = 0; a < 4; ++a)
        {
          const NodeIndex    k = mesh.cells[c][a];
          const unsigned int u = i < 3 ? unknowns.velocity(k, i) : unknowns.pressure(k);
          d += point.lambda[a] * (hat[u] - polynomial[u]);
        }
        (i < 3 ? differences.v : differences.p) += d * d * point.weight * volume;
      }
  }
  differences.v = std::sqrt(differences.v);
  differences.p = std::sqrt(differences.p);
  return differences;
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const double m : {1., 0.139})
    compare_residuals(m);

  const Differences coarse = solution_differences(0.25), fine = solution_differences(0.1);
  const auto        order = [&](double Differences::*d) {
    return std::log(coarse.*d / fine.*d) / std::log(coarse.h / fine.h);
  };
  const double v = order(&Differences::v), p = order(&Differences::p);
  std::cout << "solutions approach each other" << std::endl
            << "  velocity, order of h at least 1.8: " << (v >= 1.8 ? "yes" : "NO, " + std::to_string(v))
            << std::endl
            << "  pressure, order of h at least 1.2: " << (p >= 1.2 ? "yes" : "NO, " + std::to_string(p))
            << std::endl;
}
