// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The mini element as a space of deal.II. Proved: triangulations keep cells, nodes and patches; the hat's
// shape functions, their sums and their gradients are what they are said to be; interpolation is exact on the
// space; the residual that FEValues integrates is that of the closed form, cell by cell, for random fields
// and a power law; norms are the same on a serial and on a shared triangulation, on one and on two ranks.

#include <deal.II/distributed/shared_tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_fe.h>

#include <retroforge/discretization/fe_simplex_hat.h>
#include <retroforge/discretization/triangulation.h>
#include <retroforge/mesh/cell_faces.h>

#include <set>

#include "../element/element_test_tools.h"
#include "../remeshing/remeshing_test_tools.h"

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

void check_shapes()
{
  const FE_SimplexHat         fe;
  const dealii::Quadrature<3> rule = hat_quadrature();
  Errors                      errors;
  Random                      random;
  for (unsigned int a = 0; a < 5; ++a)
    for (unsigned int i = 0; i < 5; ++i)
      errors.compare("values at the vertices, and the bubble's at the barycentre",
                     fe.shape_value(i, fe.get_unit_support_points()[a]),
                     a < 4   ? double(i == a)
                     : i < 4 ? 0.25
                             : 1.);
  for (const dealii::Point<3> &x : rule.get_points())
    for (unsigned int i = 0; i < 5; ++i)
      for (unsigned int d = 0; d < 3; ++d)
      {
        const double     step = 1e-3; // linear up to the next face
        dealii::Point<3> right(x), left(x);
        right[d] += step;
        left[d] -= step;
        errors.compare("gradients against differences",
                       fe.shape_grad(i, x)[d],
                       (fe.shape_value(i, right) - fe.shape_value(i, left)) / (2. * step));
      }
  std::vector<double>                 dofs(5), expected = random.scalars(5);
  std::vector<dealii::Vector<double>> values(5, dealii::Vector<double>(1));
  for (unsigned int a = 0; a < 5; ++a)
    for (unsigned int i = 0; i < 5; ++i)
      values[a](0) += expected[i] * fe.shape_value(i, fe.get_unit_support_points()[a]);
  fe.convert_generalized_support_point_values_to_dof_values(values, dofs);
  errors.compare("interpolation", dofs, expected);
  errors.print(1e-12);
}

/// The residual of one cell as deal.II integrates it: s:grad of the shape functions minus p times their
/// divergence, and minus div v.
CellValues<double>
integrated(const dealii::FEValues<3> &fe, const CellValues<double> &w, const NortonHoff<double> &law)
{
  const auto velocity = [](const unsigned int d) { return dealii::FEValuesExtractors::Scalar(d); };
  const dealii::FEValuesExtractors::Scalar pressure(3);
  CellValues<double>                       R{};
  const auto                              &system  = fe.get_fe();
  const auto                               unknown = [&](auto &values, const unsigned int i) -> auto &
  {
    const auto [component, shape] = system.system_to_component_index(i);
    return component == 3 ? values.P[shape] : shape < 4 ? values.V[shape][component] : values.beta[component];
  };
  for (unsigned int q = 0; q < fe.n_quadrature_points; ++q)
  {
    dealii::Tensor<2, 3> L;
    double               p = 0.;
    for (unsigned int i = 0; i < fe.dofs_per_cell; ++i)
    {
      const unsigned int component = system.system_to_component_index(i).first;
      if (component == 3)
        p += unknown(w, i) * fe[pressure].value(i, q);
      else
        L[component] += unknown(w, i) * fe[velocity(component)].gradient(i, q);
    }
    const dealii::SymmetricTensor<2, 3> eps    = dealii::symmetrize(L);
    const dealii::SymmetricTensor<2, 3> stress = law(eps * eps) * eps;
    for (unsigned int i = 0; i < fe.dofs_per_cell; ++i)
    {
      const unsigned int component = system.system_to_component_index(i).first;
      if (component == 3)
        unknown(R, i) -= trace(L) * fe[pressure].value(i, q) * fe.JxW(q);
      else
      {
        const dealii::Tensor<1, 3> g = fe[velocity(component)].gradient(i, q);
        unknown(R, i) += (dealii::Tensor<2, 3>(stress)[component] * g - p * g[component]) * fe.JxW(q);
      }
    }
  }
  return R;
}

void check_residual(const TetMesh &mesh)
{
  dealii::Triangulation<3> triangulation;
  make_triangulation(mesh, mesh.X, triangulation);
  const dealii::FESystem<3>  fe(FE_SimplexHat(), 3, dealii::FE_SimplexP<3>(1), 1);
  const dealii::MappingFE<3> mapping(dealii::FE_SimplexP<3>(1));
  dealii::DoFHandler<3>      dofs(triangulation);
  dofs.distribute_dofs(fe);
  std::cout << "degrees of freedom: " << dofs.n_dofs() << " = 4 x " << mesh.n_nodes() << " + 3 x "
            << mesh.n_cells() << '\n';
  dealii::FEValues<3> values(mapping,
                             fe,
                             hat_quadrature(),
                             dealii::update_values | dealii::update_gradients | dealii::update_JxW_values);
  NortonHoff<double>  law;
  law.K = 2., law.m = 0.3, law.e0 = 0.1;
  Random random;
  Errors errors;
  for (const auto &cell : dofs.active_cell_iterators())
  {
    values.reinit(cell);
    const CellValues<double> w        = random.cell_values();
    const auto               geometry = cell_geometry(corners_of(mesh, cell->active_cell_index()));
    errors.compare("residual of FEValues against the closed form",
                   flatten(integrated(values, w, law)),
                   flatten(cell_residual(geometry, w, law)));
  }
  errors.print(1e-12);
}

/// L2 norms of velocity and pressure whose degrees of freedom are a function of the place, over all ranks.
template <typename Triangulation>
std::array<double, 2> norms(Triangulation &&triangulation, const TetMesh &mesh)
{
  make_triangulation(mesh, mesh.X, triangulation);
  const dealii::FESystem<3>  fe(FE_SimplexHat(), 3, dealii::FE_SimplexP<3>(1), 1);
  const dealii::MappingFE<3> mapping(dealii::FE_SimplexP<3>(1));
  dealii::DoFHandler<3>      dofs(triangulation);
  dofs.distribute_dofs(fe);
  dealii::FEValues<3> values(
    mapping, fe, hat_quadrature(), dealii::update_values | dealii::update_JxW_values);
  std::array<double, 2> sums = {{0., 0.}};
  for (const auto &cell : dofs.active_cell_iterators())
    if (cell->is_locally_owned())
    {
      values.reinit(cell);
      for (unsigned int q = 0; q < values.n_quadrature_points; ++q)
      {
        std::array<double, 4> w = {};
        for (unsigned int i = 0; i < fe.dofs_per_cell; ++i)
        {
          const auto [component, shape] = fe.system_to_component_index(i);
          const double dof =
            shape < 4 ? std::sin(cell->vertex(shape)[component % 3] + component) : 0.3 * (component + 1);
          w[component] += dof * values.shape_value_component(i, q, component);
        }
        sums[0] += (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]) * values.JxW(q);
        sums[1] += w[3] * w[3] * values.JxW(q);
      }
    }
  return sums;
}

void check_ranks(const TetMesh &mesh)
{
  const auto            serial = norms(dealii::Triangulation<3>(), mesh);
  std::array<double, 2> shared = norms(
    dealii::parallel::shared::Triangulation<3>(MPI_COMM_WORLD,
                                               dealii::Triangulation<3>::none,
                                               false,
                                               dealii::parallel::shared::Triangulation<3>::partition_metis),
    mesh);
  for (double &sum : shared)
    sum = dealii::Utilities::MPI::sum(sum, MPI_COMM_WORLD);
  Errors errors;
  errors.compare("norms on a shared triangulation", {shared[0], shared[1]}, {serial[0], serial[1]});
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    errors.print(1e-13);
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const TetMesh                            mesh = kuhn_box(3, 0.1);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
  {
    check_triangulation(mesh);
    check_shapes();
    check_residual(mesh);
  }
  check_ranks(mesh);
}
