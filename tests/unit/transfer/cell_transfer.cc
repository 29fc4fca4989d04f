// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// A cell field through the remeshing of a cylinder that is upset.
// - Two tetrahedra on a common face, of which the second gets a new tip: the first is the one kept.
// - Most cells are kept, not all; kept ones have the same four nodes, by what remeshing says itself, and
// their
//   values to the bit; constants pass to 1e-14.
// - A Gaussian of standard deviation 2h loses less than 0.2 times as much in six remeshings (L2) as through
//   the nodes alone; its mean over what is made anew stays to 1e-13 each time.
// - Random values that are not negative stay so.
// - <A x_dot, y> = <x_dot, A^T y> in the cell values, in positions of both meshes and weights of J, and in all of them,
//   A from Dual.
// - The same mesh again keeps all.

#include <deal.II/base/mpi.h>

#include "../mesh/mesh_test_tools.h"
#include "../random_numbers.h"
#include <retroforge/core/dual.h>
#include <retroforge/remeshing/local_remesher.h>
#include <retroforge/transfer/cell_to_node.h>
#include <retroforge/transfer/cell_transfer.h>

#include <algorithm>

using namespace retroforge;

/// A change of mesh, and what is taken through it.
struct Change
{
  TetMesh                old_mesh;
  NodalVectors<double>   X;
  TetMesh                new_mesh;
  std::vector<NodeIndex> old_node;
  TransferOperator       J;

  std::vector<double> apply(const std::vector<double> &q) const
  {
    return transfer_cells<double>({old_mesh, X, J, new_mesh, new_mesh.X}, q);
  }

  std::vector<double> through_nodes(const std::vector<double> &q) const
  {
    return node_to_cell(new_mesh, J.apply(cell_to_node(old_mesh, cell_volumes(old_mesh, X), q)));
  }
};

constexpr double height = 30, size = 5;

/// Upsets a mesh by the factor f and remeshes it.
Change upset(const TetMesh &mesh, const double f)
{
  Change change;
  change.old_mesh = mesh;
  change.X        = mesh.X;
  for (Vec3 &x : change.X)
    x = Vec3({x[0] / std::sqrt(f), x[1] / std::sqrt(f), f * x[2]});
  RemeshedMesh made = remesh_locally(mesh, change.X, [](const Vec3 &) { return size; }, {});
  change.new_mesh   = std::move(made.mesh);
  change.old_node   = std::move(made.old_node);
  change.J          = make_transfer(mesh, change.X, change.new_mesh, change.old_node);
  return change;
}

TetMesh cylinder()
{
  const TetMesh first =
    billet({{"shape", "cylinder"}, {"radius", "20"}, {"height", "30"}, {"element size", "5"}});
  return remesh_locally(first, first.X, [](const Vec3 &) { return size; }, {}).mesh;
}

RandomNumbers numbers;

double dot(const std::vector<double> &a, const std::vector<double> &b)
{
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += a[i] * b[i];
  return sum;
}

/// Random, and not negative.
std::vector<double> strains(const std::size_t n)
{
  std::vector<double> q = numbers.scalars(n);
  for (double &value : q)
    value = std::abs(value);
  return q;
}

/// Positions that move along random directions, which are kept.
NodalVectors<Dual> moving(const NodalVectors<double> &X, const double scale, NodalVectors<double> &X_dot)
{
  X_dot = numbers.vectors(X.size());
  NodalVectors<Dual> X_dual(X.size());
  for (std::size_t k = 0; k < X.size(); ++k)
    for (unsigned int d = 0; d < 3; ++d)
    {
      X_dot[k][d] *= scale;
      X_dual[k][d]                 = Dual(1, 0, X[k][d]);
      X_dual[k][d].fastAccessDx(0) = X_dot[k][d];
    }
  return X_dual;
}

/// Tangent along random (X_dot, q_dot) against the reverse, relative to the norms.
double defect_of_reverse(const Change &change, const double scale_X, const double scale_q)
{
  const auto        q = strains(change.old_mesh.n_cells()), y = numbers.scalars(change.new_mesh.n_cells());
  const auto        q_dot = numbers.scalars(q.size());
  std::vector<Dual> q_dual;
  for (std::size_t c = 0; c < q.size(); ++c)
  {
    q_dual.emplace_back(1, 0, q[c]);
    q_dual.back().fastAccessDx(0) = scale_q * q_dot[c];
  }
  NodalVectors<double>     X_dot, X_new_dot;
  const NodalVectors<Dual> X_dual     = moving(change.X, scale_X, X_dot),
                           X_new_dual = moving(change.new_mesh.X, scale_X, X_new_dot);
  std::vector<double> tangent;
  BasicTransfer<Dual> J;
  J.n_old = change.J.n_old;
  J.begin = change.J.begin;
  J.node  = change.J.node;
  std::vector<double> weight_bar(change.J.weight.size(), 0.), weight_dot;
  for (const double weight : change.J.weight)
  {
    weight_dot.push_back(scale_X * numbers.scalar());
    J.weight.emplace_back(weight);
    if (weight != 1.) // as nodes and cells that are kept have it
      J.weight.back().fastAccessDx(0) = weight_dot.back();
  }
  for (const Dual &value :
       transfer_cells<Dual>({change.old_mesh, X_dual, J, change.new_mesh, X_new_dual}, q_dual))
    tangent.push_back(value.dx(0));
  std::vector<double>  q_bar(q.size(), 0.);
  NodalVectors<double> X_bar(change.X.size()), X_new_bar(change.new_mesh.n_nodes());
  reverse_transfer_cells({change.old_mesh, change.X, change.J, change.new_mesh, change.new_mesh.X},
                         q,
                         y,
                         q_bar,
                         X_bar,
                         weight_bar,
                         X_new_bar);
  double reverse = scale_q * dot(q_bar, q_dot);
  for (std::size_t k = 0; k < X_bar.size(); ++k)
    reverse += X_bar[k] * X_dot[k];
  for (std::size_t k = 0; k < X_new_bar.size(); ++k)
    reverse += X_new_bar[k] * X_new_dot[k];
  for (std::size_t i = 0; i < weight_bar.size(); ++i)
    if (change.J.weight[i] != 1.)
      reverse += weight_bar[i] * weight_dot[i];
  return std::abs(dot(tangent, y) - reverse) / std::sqrt(dot(tangent, tangent) * dot(y, y));
}

/// A Gaussian in the cells, carried with the material, which was upset by f.
std::vector<double> gaussian(const TetMesh &mesh, const double f)
{
  std::vector<double> q;
  for (const auto &cell : mesh.cells)
  {
    Vec3 x = 0.25 * (mesh.X[cell[0]] + mesh.X[cell[1]] + mesh.X[cell[2]] + mesh.X[cell[3]]);
    x      = Vec3({x[0] * std::sqrt(f), x[1] * std::sqrt(f), x[2] / f}) - Vec3({2, 1, 12});
    q.push_back(std::exp(-0.5 * x.norm_square() / 100.));
  }
  return q;
}

/// Relative error in L2.
double error(const TetMesh &mesh, const std::vector<double> &q, const std::vector<double> &exact)
{
  double square = 0, exact_square = 0;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
  {
    const double V = tet_volume(corners(mesh.cells[c], mesh.X));
    square += V * (q[c] - exact[c]) * (q[c] - exact[c]);
    exact_square += V * exact[c] * exact[c];
  }
  return std::sqrt(square / exact_square);
}

/// Mean over the cells that are not marked.
double mean_of_others(const TetMesh              &mesh,
                      const NodalVectors<double> &X,
                      const std::vector<double>  &q,
                      const std::vector<bool>    &marked)
{
  double sum = 0, volume = 0;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    if (!marked[c])
    {
      const double V = tet_volume(corners(mesh.cells[c], X));
      sum += V * q[c];
      volume += V;
    }
  return sum / volume;
}

/// How much the mean over what is made anew changes.
double
defect_of_mean(const Change &change, const std::vector<double> &before, const std::vector<double> &after)
{
  std::vector<bool> kept(change.old_mesh.n_cells(), false), keeps;
  for (const CellIndex c : kept_cells(change.old_mesh, change.J, change.new_mesh))
  {
    keeps.push_back(c != invalid_index);
    if (c != invalid_index)
      kept[c] = true;
  }
  return std::abs(mean_of_others(change.new_mesh, change.new_mesh.X, after, keeps) /
                    mean_of_others(change.old_mesh, change.X, before, kept) -
                  1.);
}

void check_gaussian()
{
  TetMesh mesh = cylinder();
  double  f = 1., defect = 0.;
  auto    q = gaussian(mesh, f), through_nodes = q;
  for (unsigned int step = 0; step < 6; ++step)
  {
    const Change change = upset(mesh, 0.97);
    const auto   before = q;
    q                   = change.apply(q);
    defect              = std::max(defect, defect_of_mean(change, before, q));
    through_nodes       = change.through_nodes(through_nodes);
    mesh                = change.new_mesh;
    f *= 0.97;
  }
  const auto   exact = gaussian(mesh, f);
  const double lost = error(mesh, q, exact), lost_through_nodes = error(mesh, through_nodes, exact);
  std::cout << "Gaussian, six remeshings: loses less than 0.2 of what it loses through the nodes: "
            << yes(lost < 0.2 * lost_through_nodes) << ", mean to 1e-13: " << yes(defect < 1e-13) << "\n";
}

void check_two_cells()
{
  TetMesh two;
  two.X        = {Vec3({0, 0, 0}), Vec3({1, 0, 0}), Vec3({0, 1, 0}), Vec3({0, 0, 1}), Vec3({0, 0, -2})};
  two.cells    = {{{0, 1, 2, 3}}, {{0, 2, 1, 4}}};
  const auto J = make_transfer(two, two.X, two, {0, 1, 2, 3, invalid_index});
  std::cout << "two cells, the second with a new tip:";
  TransferOperator moved = J; // as if the tip were a mean of two nodes
  moved.node.insert(moved.node.end() - 1, 3);
  moved.weight.insert(moved.weight.end() - 1, 0.5);
  moved.weight.back() = 0.5;
  ++moved.begin.back();
  for (const CellIndex c : kept_cells(two, moved, two))
    std::cout << " " << (c == invalid_index ? "new" : std::to_string(c));
  std::cout << "\n";
}

void check_kept(const Change &change)
{
  const auto   q = strains(change.old_mesh.n_cells()), after = change.apply(q);
  const auto   old_cell = kept_cells(change.old_mesh, change.J, change.new_mesh);
  unsigned int n_kept   = 0;
  bool         same = true, bits = true;
  for (CellIndex c = 0; c < change.new_mesh.n_cells(); ++c)
  {
    if (old_cell[c] == invalid_index)
      continue;
    ++n_kept;
    bits                         = bits && after[c] == q[old_cell[c]];
    std::array<NodeIndex, 4> now = change.new_mesh.cells[c], then = change.old_mesh.cells[old_cell[c]];
    for (NodeIndex &node : now)
      node = change.old_node[node];
    std::sort(now.begin(), now.end());
    std::sort(then.begin(), then.end());
    same = same && now == then;
  }
  const double share = double(n_kept) / change.new_mesh.n_cells();
  double       ones  = 0;
  for (const double one : change.apply(std::vector<double>(change.old_mesh.n_cells(), 1.)))
    ones = std::max(ones, std::abs(one - 1.));
  std::cout << "cells kept between 60 and 95 %: " << yes(share > 0.6 && share < 0.95)
            << ", with their nodes: " << yes(same) << ", with their values: " << yes(bits)
            << ", constants: " << yes(ones < 1e-14)
            << ", none negative: " << yes(*std::min_element(after.begin(), after.end()) >= 0.) << "\n";
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check_two_cells();
  const Change change = upset(cylinder(), 0.97);
  check_kept(change);
  check_gaussian();
  std::cout << "dot product to 1e-13, cell values: " << yes(defect_of_reverse(change, 0, 1) < 1e-13)
            << ", positions and weights: " << yes(defect_of_reverse(change, 1, 0) < 1e-13)
            << ", both: " << yes(defect_of_reverse(change, 1, 1) < 1e-13) << "\n";

  std::vector<NodeIndex> all(change.new_mesh.n_nodes());
  for (NodeIndex k = 0; k < all.size(); ++k)
    all[k] = k;
  const auto identity = make_transfer(change.new_mesh, change.new_mesh.X, change.new_mesh, all);
  const auto values   = strains(change.new_mesh.n_cells());
  std::cout << "the same mesh again keeps all: "
            << yes(transfer_cells<double>(
                     {change.new_mesh, change.new_mesh.X, identity, change.new_mesh, change.new_mesh.X},
                     values) == values)
            << "\n";
}
