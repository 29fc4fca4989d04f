// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Cell values lifted to the nodes and back, on a cylinder with random cell values.
// - The integral is kept to 1e-12 both ways, against the lumped mass  m_k = sum_T |T|/4; constants are kept;
//   nodal values lie in the range of the cell values.
// - By hand, two tetrahedra of volumes 1/6 and 1/3 with values 2 and 5 on a common face: the nodes of the
//   face get (2/6 + 5/3)/(1/2) = 4, the two tips 2 and 5; back in the cells (3*4 + 2)/4 = 3.5 and 4.25.
// - <A x_dot, y> = <x_dot, A^T y> in the cell values and in the positions, A from Dual.

#include <deal.II/base/mpi.h>

#include "../mesh/mesh_test_tools.h"
#include "../random_numbers.h"
#include <retroforge/core/dual.h>
#include <retroforge/geometry/vector_algebra.h>
#include <retroforge/transfer/cell_to_node.h>

#include <algorithm>

using namespace retroforge;

RandomNumbers numbers;

double integral_over_cells(const TetMesh &mesh, const std::vector<double> &q_T)
{
  double sum = 0;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    sum += q_T[c] * tet_volume(corners(mesh.cells[c], mesh.X));
  return sum;
}

double lumped_integral(const TetMesh &mesh, const std::vector<double> &q_k)
{
  double sum = 0;
  for (const auto &cell : mesh.cells)
    for (const NodeIndex node : cell)
      sum += q_k[node] * tet_volume(corners(cell, mesh.X)) / 4;
  return sum;
}

double dot(const std::vector<double> &a, const std::vector<double> &b)
{
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += a[i] * b[i];
  return sum;
}

// Tangent along (X_dot, q_dot) against the reverse, relative to the norms.
double lift_defect(const TetMesh &mesh, const double scale_X, const double scale_q)
{
  const auto q = numbers.scalars(mesh.n_cells()), y = numbers.scalars(mesh.n_nodes());
  auto       q_dot = numbers.scalars(mesh.n_cells());
  auto       X_dot = numbers.vectors(mesh.n_nodes());
  for (double &value : q_dot)
    value *= scale_q;
  for (Vec3 &value : X_dot)
    value *= scale_X;
  std::vector<Dual>  q_dual(mesh.n_cells());
  NodalVectors<Dual> X_dual(mesh.n_nodes());
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
  {
    q_dual[c]                 = Dual(1, 0, q[c]);
    q_dual[c].fastAccessDx(0) = q_dot[c];
  }
  for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
    for (unsigned int d = 0; d < 3; ++d)
    {
      X_dual[k][d]                 = Dual(1, 0, mesh.X[k][d]);
      X_dual[k][d].fastAccessDx(0) = X_dot[k][d];
    }
  std::vector<double> tangent;
  for (const Dual &value : cell_to_node(mesh, cell_volumes(mesh, X_dual), q_dual))
    tangent.push_back(value.dx(0));
  std::vector<double>  q_bar(mesh.n_cells(), 0.), volumes_bar = q_bar;
  NodalVectors<double> X_bar(mesh.n_nodes());
  reverse_cell_to_node(mesh, cell_volumes(mesh, mesh.X), q, y, q_bar, volumes_bar);
  reverse_cell_volumes(mesh, mesh.X, volumes_bar, X_bar);
  const double reverse = dot(q_bar, q_dot) + dot(X_bar, X_dot);
  return std::abs(dot(tangent, y) - reverse) / std::sqrt(dot(tangent, tangent) * dot(y, y));
}

double restriction_defect(const TetMesh &mesh)
{
  const auto          x = numbers.scalars(mesh.n_nodes()), y = numbers.scalars(mesh.n_cells());
  std::vector<double> x_bar(mesh.n_nodes(), 0.);
  reverse_node_to_cell(mesh, y, x_bar);
  const auto Ax = node_to_cell(mesh, x);
  return std::abs(dot(Ax, y) - dot(x, x_bar)) / std::sqrt(dot(Ax, Ax) * dot(y, y));
}

void print_all(const std::string &title, const std::vector<double> &values)
{
  std::cout << title << ":";
  for (const double value : values)
    std::cout << " " << value;
  std::cout << "\n";
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  TetMesh                                  two;
  two.X     = {Vec3({0, 0, 0}), Vec3({1, 0, 0}), Vec3({0, 1, 0}), Vec3({0, 0, 1}), Vec3({0, 0, -2})};
  two.cells = {{{0, 1, 2, 3}}, {{0, 2, 1, 4}}};
  print_all("two cells, at nodes", cell_to_node(two, cell_volumes(two, two.X), std::vector<double>{2, 5}));
  print_all("back in cells",
            node_to_cell(two, cell_to_node(two, cell_volumes(two, two.X), std::vector<double>{2, 5})));

  const TetMesh mesh = billet({{"shape", "cylinder"}, {"element size", "6"}});
  const auto    q_T  = numbers.scalars(mesh.n_cells());
  const auto    q_k  = cell_to_node(mesh, cell_volumes(mesh, mesh.X), q_T);
  const double  size = volume(mesh.cells, mesh.X);
  const auto ones = cell_to_node(mesh, cell_volumes(mesh, mesh.X), std::vector<double>(mesh.n_cells(), 1.));
  std::cout << "integral kept by lifting: "
            << yes(std::abs(integral_over_cells(mesh, q_T) - lumped_integral(mesh, q_k)) < 1e-12 * size)
            << "\nintegral kept by restriction: "
            << yes(std::abs(integral_over_cells(mesh, node_to_cell(mesh, q_k)) - lumped_integral(mesh, q_k)) <
                   1e-12 * size)
            << "\nconstants kept: "
            << yes(*std::max_element(ones.begin(), ones.end()) < 1 + 1e-14 &&
                   *std::min_element(ones.begin(), ones.end()) > 1 - 1e-14)
            << "\nwithin the range: "
            << yes(*std::max_element(q_k.begin(), q_k.end()) <= *std::max_element(q_T.begin(), q_T.end()) &&
                   *std::min_element(q_k.begin(), q_k.end()) >= *std::min_element(q_T.begin(), q_T.end()))
            << "\n";
  std::cout << "dot product to 1e-13, cell values: " << yes(lift_defect(mesh, 0, 1) < 1e-13)
            << "\ndot product to 1e-13, positions: " << yes(lift_defect(mesh, 1, 0) < 1e-13)
            << "\ndot product to 1e-13, both: " << yes(lift_defect(mesh, 1, 1) < 1e-13)
            << "\ndot product to 1e-13, restriction: " << yes(restriction_defect(mesh) < 1e-13) << "\n";
}
