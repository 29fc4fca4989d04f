// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The accumulated equivalent strain and its reverse, on a mesh of 12 cells about one inner node, of both
// pairs in closed form and by quadrature. Proved, on one rank and on two:
// - by hand: upsetting V = s (x/2, y/2, -z) has eps = s diag(1/2, 1/2, -1) and e = s, simple shear
//   V = s (z, 0, 0) has e = s/sqrt(3); over dt = 0.25 with s = 0.8 each cell gains 0.2 and 0.11547; with any
//   velocity it gains the mean of cell_strain_rates(). A rank leaves the cells of others alone;
// - <A x_dot, y> = <x_dot, A^T y> for all inputs (V at vertices, V in bubbles or middles, X, q, dt) at once
// and
//   for each alone, A from Dual;
// - at rest, and where the bubble brings one sub-tetrahedron of a cell to rest, derivatives are finite; in
// the
//   first case they are zero.

#include <deal.II/base/mpi.h>

#include <retroforge/core/dual.h>
#include <retroforge/discretization/strain_history.h>
#include <retroforge/mesh/mesh_quality.h>

#include "../element/element_test_tools.h"

using namespace retroforge;

namespace
{
  // A cube of edge 2 cut into two tetrahedra per face and the centre, its corners shaken.
  TetMesh small_mesh(Random &random)
  {
    TetMesh mesh;
    for (unsigned int i = 0; i < 8; ++i)
      mesh.X.push_back(Vec3({i & 1 ? 1. : -1., i & 2 ? 1. : -1., i & 4 ? 1. : -1.}) + 0.2 * random.vector());
    mesh.X.push_back(0.2 * random.vector());
    const unsigned int sides[6][4] = {
      {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto &s : sides)
      for (const auto &cell : {std::array<NodeIndex, 4>{{s[0], s[1], s[2], 8}}, {{s[0], s[2], s[3], 8}}})
      {
        auto &last = mesh.cells.emplace_back(cell);
        if (tet_volume(corners(last, mesh.X)) < 0.)
          std::swap(last[0], last[1]);
      }
    return mesh;
  }

  /// Everything the update depends on, or a direction in that, or an adjoint of it.
  template <typename Number>
  struct Inputs
  {
    NodalVectors<Number> X;
    Field<Number>        W;
    Number               dt = Number(0.);
    std::vector<Number>  q;

    /// Zeros.
    explicit Inputs(const Discretization<3> &spaces)
        : X(spaces.n_vertices()), W(spaces), q(spaces.cells().range().n, Number(0.))
    {
    }

    std::vector<Number *> entries()
    {
      std::vector<Number *> all;
      const auto            add = [&](auto &vectors) {
        for (auto &v : vectors)
          for (unsigned int d = 0; d < 3; ++d)
            all.push_back(&v[d]);
      };
      add(X);
      add(W.V);
      all.push_back(&dt);
      for (Number &value : q)
        all.push_back(&value);
      return all;
    }
  };

  /// The same on all ranks.
  Inputs<double> random_inputs(const Discretization<3> &spaces, Random &random)
  {
    Inputs<double> inputs(spaces);
    inputs.X = random.vectors(inputs.X.size());
    inputs.W.V.take(random.vectors(spaces.velocity_nodes()->n()));
    inputs.dt = random.scalar();
    inputs.q  = random.scalars(inputs.q.size());
    return inputs;
  }

  /// Sets those velocities to zero that are not at vertices, or those that are.
  void keep(const Discretization<3> &spaces, const bool at_vertices, NodeVector<3, double> &V)
  {
    for (unsigned int place = 0; place < V.size(); ++place)
      if ((spaces.velocity_nodes()->node_at(place) < spaces.n_vertices()) != at_vertices)
        V.at_place(place) = Vec3();
  }

  /// The tangent along `direction` against the reverse of y, relative to the sum of absolute products.
  double dot_product_defect(const Discretization<3>   &spaces,
                            Inputs<double>             at,
                            Inputs<double>             direction,
                            const std::vector<double> &y)
  {
    Inputs<Dual> dual(spaces);
    const auto   in = at.entries(), in_dot = direction.entries();
    const auto   in_dual = dual.entries();
    for (std::size_t i = 0; i < in.size(); ++i)
    {
      *in_dual[i]                 = Dual(1, 0, *in[i]);
      in_dual[i]->fastAccessDx(0) = *in_dot[i];
    }
    const auto     tangent = accumulate_strain(spaces, dual.X, dual.W, dual.dt, dual.q);
    Inputs<double> bar(spaces);
    bar.dt         = reverse_accumulate_strain(spaces, at.X, at.W, at.dt, y, bar.W, bar.X);
    double forward = 0., reverse = 0., size = 0.;
    for (const CellIndex c : spaces.cells().owned())
    {
      bar.q[c] = y[c];
      forward += tangent[c].dx(0) * y[c];
      size += std::abs(tangent[c].dx(0) * y[c]);
    }
    const auto in_bar = bar.entries();
    for (std::size_t i = 0; i < in_bar.size(); ++i)
      reverse += *in_bar[i] * *in_dot[i];
    size                = spaces.sum(size);
    const double defect = std::abs(spaces.sum(forward - reverse)) / (size > 0. ? size : 1.);
    return std::isfinite(defect) ? defect : 1e300;
  }

  /// Of a flow that both pairs have.
  template <typename Flow>
  Field<double> field_of(const TetMesh &mesh, const Discretization<3> &spaces, const Flow &flow)
  {
    NodalVectors<double> V;
    for (const Vec3 &x : mesh.X)
      V.push_back(flow(x));
    return interpolated(spaces, V, std::vector<double>(V.size(), 0.));
  }

  void check_values(const TetMesh              &mesh,
                    const Discretization<3>    &spaces,
                    const DiscretizationChoice &choice,
                    Random                     &random)
  {
    const auto flow  = field_of(mesh, spaces, [](const Vec3 &x) {
      return 0.8 * Vec3({x[0] / 2, x[1] / 2, -x[2]});
    });
    const auto shear = field_of(mesh, spaces, [](const Vec3 &x) { return 0.8 * Vec3({x[2], 0., 0.}); });
    const std::vector<double> none(mesh.n_cells(), 0.), upset(mesh.n_cells(), 0.2),
      sheared(mesh.n_cells(), 0.2 + 0.2 / std::sqrt(3.));
    const auto whole = [&](std::vector<double> q) {
      spaces.cells().complete(q.data(), 1);
      return q;
    };
    Errors     errors;
    const auto q = whole(accumulate_strain(spaces, mesh.X, flow, 0.25, none));
    errors.compare("upsetting", q, upset);
    errors.compare("shear after it", whole(accumulate_strain(spaces, mesh.X, shear, 0.25, q)), sheared);

    const Inputs<double> any      = random_inputs(spaces, random);
    std::vector<double>  expected = any.q;
    for (const CellIndex c : spaces.cells().owned())
    {
      const auto geometry = geometry_of_cell(spaces, mesh.X, c);
      const auto e        = choice.pair == ElementPair::mini
                              ? cell_strain_rates(geometry, MiniPair::on_cell(spaces, any.W, c))
                              : cell_strain_rates(geometry, TaylorHoodPair::on_cell(spaces, any.W, c));
      expected[c] += any.dt * (e[0] + e[1] + e[2] + e[3]) / 4.;
    }
    const auto found      = accumulate_strain(spaces, mesh.X, any.W, any.dt, any.q);
    double     difference = 0.;
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      difference += std::abs(found[c] - expected[c]);
    errors.compare("any velocity, and cells of others", spaces.sum(difference), 0.);
    errors.print(1e-14);
  }

  void check_reverse(const TetMesh &mesh, const Discretization<3> &spaces, Random &random)
  {
    Errors errors;
    for (unsigned int n = 0; n < 20; ++n)
    {
      Inputs<double> at    = random_inputs(spaces, random);
      at.X                 = mesh.X;
      const auto y         = random_inputs(spaces, random).q;
      const auto direction = random_inputs(spaces, random);
      const auto alone     = [&](const std::string &what, const auto &choose) {
        Inputs<double> part(spaces);
        choose(part);
        errors.compare(what, 1. + dot_product_defect(spaces, at, part, y), 1.);
      };
      alone("dot product, all", [&](auto &part) { part = direction; });
      for (const bool at_vertices : {true, false})
        alone(at_vertices ? "dot product, V at vertices" : "dot product, other V", [&](auto &part) {
          part.W = direction.W;
          keep(spaces, at_vertices, part.W.V);
        });
      alone("dot product, X", [&](auto &part) { part.X = direction.X; });
      alone("dot product, dt", [&](auto &part) { part.dt = direction.dt; });
      alone("dot product, q", [&](auto &part) { part.q = direction.q; });
    }
    errors.print(1e-13);
  }

  /// Largest entry of the reverse in V and X; huge when it is not finite.
  double largest_derivative(const TetMesh &mesh, const Discretization<3> &spaces, const Field<double> &W)
  {
    Inputs<double> bar(spaces);
    reverse_accumulate_strain(spaces, mesh.X, W, 0.25, std::vector<double>(mesh.n_cells(), 1.), bar.W, bar.X);
    double largest = 0.;
    for (const double *entry : bar.entries())
      largest = std::isfinite(*entry) ? std::max(largest, std::abs(*entry)) : 1e300;
    return dealii::Utilities::MPI::max(largest, spaces.comm());
  }

  void check_at_rest(const TetMesh &mesh, const Discretization<3> &spaces, Random &random)
  {
    Inputs<double> at(spaces);
    at.X  = mesh.X;
    at.dt = 0.25;
    Errors errors;
    errors.compare("no derivative at rest", largest_derivative(mesh, spaces, at.W), 0.);
    errors.compare(
      "dot product at rest",
      1. + dot_product_defect(spaces, at, random_inputs(spaces, random), random_inputs(spaces, random).q),
      1.);
    errors.print(1e-13);
  }

  /// On w_0 of cell 0 the bubble's gradient 4 beta (x) g_0 cancels that of the nodes, V_0 (x) g_0.
  void check_part_at_rest(const TetMesh &mesh, const Discretization<3> &spaces)
  {
    Field<double> W(spaces);
    const Vec3    beta             = Vec3({0.5, 0.25, -1});
    MiniPair::bubble(spaces, W, 0) = beta;
    W.V[mesh.cells[0][0]]          = -4. * beta;
    const auto e = cell_strain_rates(geometry_of_cell(spaces, mesh.X, 0), MiniPair::on_cell(spaces, W, 0));
    Errors     errors;
    errors.compare("one part of a cell at rest", e[0], 0.);
    errors.print(1e-13);
    std::cout << "  the others move, derivatives finite: "
              << (e[1] > 0.1 && largest_derivative(mesh, spaces, W) < 100. ? "yes" : "NO") << std::endl;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
    std::cout.setstate(std::ios::failbit);
  Random        random;
  const TetMesh mesh = small_mesh(random);
  for (const Assembly assembly : {Assembly::closed_form, Assembly::quadrature})
    for (const ElementPair pair : {ElementPair::mini, ElementPair::taylor_hood})
    {
      const DiscretizationChoice choice{pair, TriangulationKind::shared, assembly};
      std::cout << (pair == ElementPair::mini ? "mini" : "P2-P1")
                << (assembly == Assembly::quadrature ? " by quadrature" : " in closed form") << std::endl;
      const Discretization<3> spaces(mesh, choice, MPI_COMM_WORLD);
      check_values(mesh, spaces, choice, random);
      check_reverse(mesh, spaces, random);
      check_at_rest(mesh, spaces, random);
      if (pair == ElementPair::mini)
        check_part_at_rest(mesh, Discretization<3>(mesh, choice, MPI_COMM_SELF));
    }
}
