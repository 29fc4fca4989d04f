// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The pairs of elements as spaces of deal.II. Proved: triangulations keep cells, nodes and patches; the hat's
// shape functions, their sums and their gradients are what they are said to be; interpolation is exact on the
// space; for both pairs, the residual that FEValues integrates is that of the closed form, cell by cell, for
// random fields and a power law; and norms are the same on a serial, a shared and a fully distributed
// triangulation, on one and on two ranks.

#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/distributed/shared_tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria_description.h>

#include <retroforge/discretization/triangulation.h>
#include <retroforge/element/fe_simplex_hat.h>
#include <retroforge/mesh/cell_faces.h>

#include <set>

#include "../element/element_test_tools.h"
#include "../remeshing/remeshing_test_tools.h"
#include "middles_of.h"

using namespace retroforge;

Four<Vec3> corners_of(const TetMesh &mesh, const CellIndex c)
{
  Four<Vec3> X;
  for (unsigned int a = 0; a < 4; ++a)
    X[a] = mesh.X[mesh.cells[c][a]];
  return X;
}

void check_triangulation(const TetMesh &mesh)
{
  dealii::Triangulation<3> triangulation;
  make_triangulation(mesh, mesh.X, triangulation);
  bool                  same = triangulation.n_active_cells() == mesh.n_cells();
  std::set<std::string> patches;
  for (const auto &cell : triangulation.active_cell_iterators())
  {
    for (unsigned int a = 0; a < 4; ++a)
      same = same && cell->vertex_index(a) == mesh.cells[cell->active_cell_index()][a] &&
             Vec3(cell->vertex(a)) == mesh.X[cell->vertex_index(a)];
    for (const auto &face : cell->face_iterators())
      if (face->at_boundary())
        for (const BoundaryFace &expected : mesh.faces)
          if (face_key(expected.nodes) ==
              face_key({{face->vertex_index(0), face->vertex_index(1), face->vertex_index(2)}}))
          {
            same = same && face->boundary_id() == expected.patch;
            patches.insert(mesh.patches[face->boundary_id()].name);
          }
  }
  std::cout << "cells, nodes and patches are the mesh's: " << (same ? "yes" : "NO") << ", " << patches.size()
            << " patches\n";
}

template <int dim>
void check_shapes()
{
  constexpr unsigned int        n = dim + 2;
  const FE_SimplexHat<dim>      fe;
  const dealii::Quadrature<dim> rule = hat_quadrature<dim>();
  Errors                        errors;
  Random                        random;
  for (unsigned int a = 0; a < n; ++a)
    for (unsigned int i = 0; i < n; ++i)
      errors.compare("values at the vertices, and the bubble's at the barycentre",
                     fe.shape_value(i, fe.get_unit_support_points()[a]),
                     a <= dim   ? double(i == a)
                     : i <= dim ? 1. / (dim + 1.)
                                : 1.);
  for (const dealii::Point<dim> &x : rule.get_points())
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int d = 0; d < dim; ++d)
      {
        const double       step = 1e-3; // linear up to the next face
        dealii::Point<dim> right(x), left(x);
        right[d] += step;
        left[d] -= step;
        errors.compare("gradients against differences",
                       fe.shape_grad(i, x)[d],
                       (fe.shape_value(i, right) - fe.shape_value(i, left)) / (2. * step));
      }
  std::vector<double>                 dofs(n), expected = random.scalars(n);
  std::vector<dealii::Vector<double>> values(n, dealii::Vector<double>(1));
  for (unsigned int a = 0; a < n; ++a)
    for (unsigned int i = 0; i < n; ++i)
      values[a](0) += expected[i] * fe.shape_value(i, fe.get_unit_support_points()[a]);
  fe.convert_generalized_support_point_values_to_dof_values(values, dofs);
  errors.compare("interpolation", dofs, expected);
  // That of a cone of height 1.
  const double volume = fe.reference_cell().volume();
  for (const auto &points : {rule, iterated_on_hat(dealii::QGaussSimplex<dim>(2))})
  {
    double integral = 0.;
    for (unsigned int q = 0; q < points.size(); ++q)
      integral += fe.shape_value(dim + 1, points.point(q)) * points.weight(q);
    errors.compare("integral of the bubble", integral, volume / (dim + 1.));
  }
  std::cout << fe.get_name() << '\n';
  errors.print(1e-12);
}

/// The mini element as deal.II knows it.
struct MiniSpace
{
  static constexpr const char *name = "mini";
  using Values                      = CellValues<double>;

  static dealii::FESystem<3>   fe() { return {FE_SimplexHat<3>(), 3, dealii::FE_SimplexP<3>(1), 1}; }
  static dealii::Quadrature<3> rule() { return hat_quadrature<3>(); }
  static Values                random_values(Random &random) { return random.cell_values(); }
  static unsigned int          n_dofs(const TetMesh &mesh) { return 4 * mesh.n_nodes() + 3 * mesh.n_cells(); }
  static double               &velocity(Values &w, const unsigned int shape, const unsigned int component)
  {
    return shape < 4 ? w.V[shape][component] : w.beta[component];
  }
};

/// That of Taylor and Hood.
struct QuadraticSpace
{
  static constexpr const char *name = "P2-P1";
  using Values                      = TaylorHoodValues<double>;

  static dealii::FESystem<3> fe() { return {dealii::FE_SimplexP<3>(2), 3, dealii::FE_SimplexP<3>(1), 1}; }
  /// Four points of equal weights, exact for quadratic polynomials.
  static dealii::Quadrature<3> rule()
  {
    const double                  own = (5. + 3. * std::sqrt(5.)) / 20., other = (5. - std::sqrt(5.)) / 20.;
    std::vector<dealii::Point<3>> points(4, dealii::Point<3>(other, other, other));
    for (unsigned int d = 0; d < 3; ++d)
      points[d + 1][d] = own;
    return {points, std::vector<double>(4, 1. / 24.)};
  }
  static Values       random_values(Random &random) { return random.taylor_hood_values(); }
  static unsigned int n_dofs(const TetMesh &mesh) { return 4 * mesh.n_nodes() + 3 * middles_of(mesh).size(); }
  static double      &velocity(Values &w, const unsigned int shape, const unsigned int component)
  {
    return w.V[shape][component];
  }
};

/// The residual of one cell as deal.II integrates it: s:grad of the shape functions minus p times their
/// divergence, and minus div v.
template <typename Space>
typename Space::Values
integrated(const dealii::FEValues<3> &fe, const typename Space::Values &w, const NortonHoff<double> &law)
{
  const auto  extractor = [](const unsigned int d) { return dealii::FEValuesExtractors::Scalar(d); };
  const auto &system    = fe.get_fe();
  typename Space::Values R{};
  const auto             unknown = [&](typename Space::Values &values, const unsigned int i) -> double             &{
    const auto [component, shape] = system.system_to_component_index(i);
    return component == 3 ? values.P[shape] : Space::velocity(values, shape, component);
  };
  typename Space::Values at = w;
  for (unsigned int q = 0; q < fe.n_quadrature_points; ++q)
  {
    dealii::Tensor<2, 3> L;
    double               p = 0.;
    for (unsigned int i = 0; i < fe.dofs_per_cell; ++i)
    {
      const unsigned int component = system.system_to_component_index(i).first;
      if (component == 3)
        p += unknown(at, i) * fe[extractor(3)].value(i, q);
      else
        L[component] += unknown(at, i) * fe[extractor(component)].gradient(i, q);
    }
    const dealii::SymmetricTensor<2, 3> eps    = dealii::symmetrize(L);
    const dealii::SymmetricTensor<2, 3> stress = law(eps * eps) * eps;
    for (unsigned int i = 0; i < fe.dofs_per_cell; ++i)
    {
      const unsigned int component = system.system_to_component_index(i).first;
      if (component == 3)
        unknown(R, i) -= trace(L) * fe[extractor(3)].value(i, q) * fe.JxW(q);
      else
      {
        const dealii::Tensor<1, 3> g = fe[extractor(component)].gradient(i, q);
        unknown(R, i) += (dealii::Tensor<2, 3>(stress)[component] * g - p * g[component]) * fe.JxW(q);
      }
    }
  }
  return R;
}

template <typename Space>
void check_residual(const TetMesh &mesh)
{
  dealii::Triangulation<3> triangulation;
  make_triangulation(mesh, mesh.X, triangulation);
  const dealii::FESystem<3>  fe = Space::fe();
  const dealii::MappingFE<3> mapping(dealii::FE_SimplexP<3>(1));
  dealii::DoFHandler<3>      dofs(triangulation);
  dofs.distribute_dofs(fe);
  std::cout << Space::name << ", degrees of freedom: " << dofs.n_dofs() << " of " << Space::n_dofs(mesh)
            << '\n';
  dealii::FEValues<3> values(
    mapping, fe, Space::rule(), dealii::update_values | dealii::update_gradients | dealii::update_JxW_values);
  NortonHoff<double> law;
  law.K = 2., law.m = 0.3, law.e0 = 0.1;
  Random random;
  Errors errors;
  for (const auto &cell : dofs.active_cell_iterators())
  {
    values.reinit(cell);
    const auto w        = Space::random_values(random);
    const auto geometry = cell_geometry(corners_of(mesh, cell->active_cell_index()));
    errors.compare("residual of FEValues against the closed form",
                   flatten(integrated<Space>(values, w, law)),
                   flatten(cell_residual(geometry, w, law)));
  }
  errors.print(1e-12);
}

/// L2 norms of velocity and pressure whose degrees of freedom are a function of the place, and of the
/// velocity's gradient, over all ranks.
template <typename Space>
std::vector<double> norms(const dealii::Triangulation<3> &triangulation)
{
  const dealii::FESystem<3>  fe = Space::fe();
  const dealii::MappingFE<3> mapping(dealii::FE_SimplexP<3>(1));
  dealii::DoFHandler<3>      dofs(triangulation);
  dofs.distribute_dofs(fe);
  dealii::FEValues<3> values(
    mapping, fe, Space::rule(), dealii::update_values | dealii::update_gradients | dealii::update_JxW_values);
  std::vector<double> sums(3, 0.);
  for (const auto &cell : dofs.active_cell_iterators())
    if (cell->is_locally_owned())
    {
      values.reinit(cell);
      for (unsigned int q = 0; q < values.n_quadrature_points; ++q)
      {
        std::array<double, 4>               w = {};
        std::array<dealii::Tensor<1, 3>, 4> grad;
        for (unsigned int i = 0; i < fe.dofs_per_cell; ++i)
        {
          const auto [component, shape] = fe.system_to_component_index(i);
          const auto  &points           = fe.base_element(component < 3 ? 0 : 1).get_unit_support_points();
          const auto   x                = mapping.transform_unit_to_real_cell(cell, points[shape]);
          const double dof              = std::sin(x[component % 3] + component);
          w[component] += dof * values.shape_value_component(i, q, component);
          grad[component] += dof * values.shape_grad_component(i, q, component);
        }
        for (unsigned int d = 0; d < 3; ++d)
        {
          sums[0] += w[d] * w[d] * values.JxW(q);
          sums[1] += grad[d].norm_square() * values.JxW(q);
        }
        sums[2] += w[3] * w[3] * values.JxW(q);
      }
    }
  return sums;
}

std::vector<double> sum_over_ranks(std::vector<double> sums)
{
  for (double &sum : sums)
    sum = dealii::Utilities::MPI::sum(sum, MPI_COMM_WORLD);
  return sums;
}

template <typename Space>
void check_ranks(const TetMesh &mesh)
{
  dealii::Triangulation<3> serial;
  make_triangulation(mesh, mesh.X, serial);
  const std::vector<double> expected = norms<Space>(serial);
  using Shared                       = dealii::parallel::shared::Triangulation<3>;
  Shared shared(MPI_COMM_WORLD, Shared::none, false, Shared::partition_metis);
  make_triangulation(mesh, mesh.X, shared);
  dealii::GridTools::partition_triangulation(dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD), serial);
  dealii::parallel::fullydistributed::Triangulation<3> distributed(MPI_COMM_WORLD);
  distributed.create_triangulation(
    dealii::TriangulationDescription::Utilities::create_description_from_triangulation(serial,
                                                                                       MPI_COMM_WORLD));
  Errors errors;
  errors.compare("norms on a shared triangulation", sum_over_ranks(norms<Space>(shared)), expected);
  errors.compare(
    "norms on a fully distributed triangulation", sum_over_ranks(norms<Space>(distributed)), expected);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    errors.print(1e-13);
}

template <typename Space>
void check(const TetMesh &mesh)
{
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    check_residual<Space>(mesh);
  check_ranks<Space>(mesh);
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const TetMesh                            mesh = kuhn_box(3, 0.1);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
  {
    check_triangulation(mesh);
    check_shapes<2>();
    check_shapes<3>();
  }
  check<MiniSpace>(mesh);
  check<QuadraticSpace>(mesh);
}
