// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Point location and the transfer operator J between unrelated meshes of one part.
// - The cell found for a point is the one found by trying all of them: compared through the piecewise linear
//   interpolant of x^2 + 2 yz, which differs from cell to cell (a linear field would not show a wrong cell).
//   That interpolant is off by some tenths of h^2. Points outside get the closest point of the mesh: on the
//   box, by hand.
// - Rows sum to one, with weights in [0, 1] when linear (with gradients they are not). Linear
//   fields are exact at X' - c,  J X + c = X', <J x, y> = <x, J^T y>.
// - Rows of the surface hold nodes of the same patch only; ridge rows nodes of the ridge, corners one node.
// - Of a quadratic field on a cube, gradients take away 99 % of the error inside, on patches and on ridges.
// - Values that vanish on a symmetry plane vanish there afterwards.
// - Kept nodes keep their values bit for bit; twice the same meshes give twice the same bits.

#include <deal.II/base/mpi.h>

#include "../mesh/mesh_test_tools.h"
#include "../random_numbers.h"
#include <retroforge/core/dual.h>
#include <retroforge/mesh/boundary_location.h>
#include <retroforge/mesh/topology.h>
#include <retroforge/transfer/transfer.h>

#include <algorithm>

using namespace retroforge;

double quadratic(const Vec3 &x)
{
  return x[0] * x[0] + 2. * x[1] * x[2];
}

double value_at(const TetMesh &mesh, const CellIndex c, const std::array<double, 4> &weights)
{
  double value = 0;
  for (unsigned int a = 0; a < 4; ++a)
    value += weights[a] * quadratic(mesh.X[mesh.cells[c][a]]);
  return value;
}

double value_by_brute_force(const TetMesh &mesh, const Vec3 &x)
{
  double    depth = -1e300;
  CellIndex best  = 0;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
  {
    const auto   weights  = barycentric_coordinates(x, corners(mesh.cells[c], mesh.X));
    const double smallest = *std::min_element(weights.begin(), weights.end());
    if (smallest > depth)
    {
      depth = smallest;
      best  = c;
    }
  }
  return value_at(mesh, best, barycentric_coordinates(x, corners(mesh.cells[best], mesh.X)));
}

void test_location()
{
  const double      h    = 3;
  const TetMesh     mesh = billet({{"size", "40, 40, 40"}, {"element size", "3"}});
  const CellLocator locator(mesh, mesh.X);
  RandomNumbers     random;
  double            difference = 0, error = 0, outside = 0;
  for (unsigned int i = 0; i < 500; ++i)
  {
    const Vec3      x     = 20. * (random.vector() + Vec3({0, 0, 1}));
    const CellPoint point = locator.locate(x);
    const double    value = value_at(mesh, point.cell, point.weights);
    difference            = std::max(difference, std::abs(value - value_by_brute_force(mesh, x)));
    error                 = std::max(error, std::abs(value - quadratic(x)) / (h * h));

    const Vec3      far  = 1.2 * x;
    const CellPoint near = locator.locate(far);
    Vec3            closest, found;
    for (unsigned int d = 0; d < 3; ++d)
      closest[d] = std::clamp(far[d], d == 2 ? 0. : -20., d == 2 ? 40. : 20.);
    for (unsigned int a = 0; a < 4; ++a)
      found += near.weights[a] * mesh.X[mesh.cells[near.cell][a]];
    outside = std::max(outside, (found - closest).norm());
  }
  std::cout << "point location, thousands of cells: " << yes(mesh.n_cells() > 5000)
            << "\n  as by brute force to 1e-11: " << yes(difference < 1e-11)
            << "\n  interpolation error between h^2/100 and h^2: " << yes(error < 1. && error > 0.01)
            << "\n  closest point from outside to 1e-12: " << yes(outside < 1e-12) << "\n";
}

double defect_of_sums(const TransferOperator &J)
{
  double defect = 0;
  for (const double sum : J.apply(std::vector<double>(J.n_old, 1.)))
    defect = std::max(defect, std::abs(sum - 1.));
  return defect;
}

// Linear field  1 + a·x  against its value where the row points, X' - c.
double defect_of_linear_field(const TetMesh &old_mesh, const TetMesh &new_mesh, const TransferOperator &J)
{
  const Vec3          a({0.3, -0.2, 0.5});
  std::vector<double> q;
  for (const Vec3 &x : old_mesh.X)
    q.push_back(1. + a * x);
  const auto transferred = J.apply(q);
  double     defect      = 0;
  for (NodeIndex k = 0; k < J.n_new(); ++k)
    defect = std::max(defect, std::abs(transferred[k] - 1. - a * (new_mesh.X[k] - J.offset[k])));
  return defect / 20;
}

// <J x, y> - <x, J^T y>, relative to the sum of absolute values.
double defect_of_transpose(const TransferOperator &J)
{
  RandomNumbers random;
  const auto    x = random.vectors(J.n_old), y = random.vectors(J.n_new());
  const auto    Jx = J.apply(x), Jty = J.apply_transpose(y);
  const auto    u = random.scalars(J.n_old), v = random.scalars(J.n_new());
  const auto    Ju = J.apply(u), Jtv = J.apply_transpose(v);
  double        forward = 0, reverse = 0, size = 0;
  for (NodeIndex k = 0; k < J.n_new(); ++k)
  {
    forward += Jx[k] * y[k] + Ju[k] * v[k];
    size += std::abs(Jx[k] * y[k]) + std::abs(Ju[k] * v[k]);
  }
  for (NodeIndex k = 0; k < J.n_old; ++k)
    reverse += x[k] * Jty[k] + u[k] * Jtv[k];
  return std::abs(forward - reverse) / size;
}

// With Dual values and derivatives are transferred alike.
double defect_of_dual(const TransferOperator &J)
{
  RandomNumbers      random;
  const auto         x = random.vectors(J.n_old), x_dot = random.vectors(J.n_old);
  NodalVectors<Dual> dual(J.n_old);
  for (NodeIndex k = 0; k < J.n_old; ++k)
    for (unsigned int d = 0; d < 3; ++d)
    {
      dual[k][d]                 = x[k][d];
      dual[k][d].fastAccessDx(0) = x_dot[k][d];
    }
  BasicTransfer<Dual> with_duals;
  with_duals.n_old = J.n_old;
  with_duals.begin = J.begin;
  with_duals.node  = J.node;
  with_duals.weight.assign(J.weight.begin(), J.weight.end());
  const auto transferred = with_duals.apply(dual);
  const auto value = J.apply(x), derivative = J.apply(x_dot);
  double     defect = 0;
  for (NodeIndex k = 0; k < J.n_new(); ++k)
    for (unsigned int d = 0; d < 3; ++d)
      defect = std::max({defect,
                         std::abs(transferred[k][d].val() - value[k][d]),
                         std::abs(transferred[k][d].dx(0) - derivative[k][d])});
  return defect;
}

bool surface_rows_stay_on_surface(const TetMesh &old_mesh, const TetMesh &new_mesh, const TransferOperator &J)
{
  const auto old_patches = patches_at_nodes(old_mesh), new_patches = patches_at_nodes(new_mesh);
  for (NodeIndex k = 0; k < J.n_new(); ++k)
  {
    const auto &patches = new_patches[k];
    if (patches.size() > 2 && J.begin[k + 1] - J.begin[k] > 1)
      return false;
    for (unsigned int i = J.begin[k]; i < J.begin[k + 1]; ++i)
      if (!std::includes(
            old_patches[J.node[i]].begin(), old_patches[J.node[i]].end(), patches.begin(), patches.end()))
        return false;
  }
  return true;
}

// Quadratic field  x^2 + 2 yz - 0.5 z^2  against its value at the new nodes: the largest error of those
// inside, of patches and of ridges.
std::array<double, 3>
defects_of_quadratic_field(const TetMesh &old_mesh, const TetMesh &new_mesh, const TransferOperator &J)
{
  const auto          value   = [](const Vec3 &x) { return quadratic(x) - 0.5 * x[2] * x[2]; };
  const auto          patches = patches_at_nodes(new_mesh);
  std::vector<double> q;
  for (const Vec3 &x : old_mesh.X)
    q.push_back(value(x));
  const auto            transferred = J.apply(q);
  std::array<double, 3> defects     = {};
  for (NodeIndex k = 0; k < J.n_new(); ++k)
    if (patches[k].size() < 3)
      defects[patches[k].size()] =
        std::max(defects[patches[k].size()], std::abs(transferred[k] - value(new_mesh.X[k])));
  return defects;
}

// What gradients leave of the error of a quadratic field.
void test_quadratic(const TetMesh &old_mesh, const TetMesh &new_mesh)
{
  const std::vector<NodeIndex> all_new(new_mesh.n_nodes(), invalid_index);
  const auto                   defects = [&](const Interpolation interpolation) {
    return defects_of_quadratic_field(
      old_mesh, new_mesh, make_transfer(old_mesh, old_mesh.X, new_mesh, all_new, interpolation));
  };
  const auto linear = defects(Interpolation::linear), gradient = defects(Interpolation::half_gradient);
  std::cout << "quadratic field, error with gradients below 1 % of that without: inside "
            << yes(gradient[0] < 0.01 * linear[0]) << ", on patches " << yes(gradient[1] < 0.01 * linear[1])
            << ", on ridges " << yes(gradient[2] < 0.01 * linear[2]) << "\n";
}

double largest_position_defect(const TetMesh &old_mesh, const TetMesh &new_mesh, const TransferOperator &J)
{
  const auto X      = J.apply(old_mesh.X);
  double     defect = 0;
  for (NodeIndex k = 0; k < J.n_new(); ++k)
    defect = std::max(defect, (X[k] + J.offset[k] - new_mesh.X[k]).norm());
  return defect;
}

double largest_offset(const TransferOperator &J)
{
  double largest = 0;
  for (const Vec3 &c : J.offset)
    largest = std::max(largest, c.norm());
  return largest;
}

// The normal component of a velocity that has none on the symmetry planes.
double
normal_velocity_on_symmetry(const TetMesh &old_mesh, const TetMesh &new_mesh, const TransferOperator &J)
{
  const Topology old_topology(old_mesh), new_topology(new_mesh);
  RandomNumbers  random;
  auto           V = random.vectors(old_mesh.n_nodes());
  for (NodeIndex k = 0; k < old_mesh.n_nodes(); ++k)
    for (const Vec3 &direction : old_topology.fixed_directions[k])
      V[k] -= (V[k] * direction) * direction;
  V              = J.apply(V);
  double largest = 0;
  for (NodeIndex k = 0; k < new_mesh.n_nodes(); ++k)
    for (const Vec3 &direction : new_topology.fixed_directions[k])
      largest = std::max(largest, std::abs(V[k] * direction));
  return largest;
}

bool weights_are_convex(const TransferOperator &J)
{
  return std::all_of(J.weight.begin(), J.weight.end(), [](const double w) { return w >= 0 && w <= 1; });
}

bool same_bits(const TransferOperator &a, const TransferOperator &b)
{
  return a.begin == b.begin && a.node == b.node && a.weight == b.weight && a.offset == b.offset;
}

void test_transfer(const std::string &title,
                   const TetMesh     &old_mesh,
                   const TetMesh     &new_mesh,
                   const bool         is_plane)
{
  const std::vector<NodeIndex> all_new(new_mesh.n_nodes(), invalid_index);
  for (const auto interpolation : {Interpolation::linear, Interpolation::half_gradient})
  {
    const auto J = make_transfer(old_mesh, old_mesh.X, new_mesh, all_new, interpolation);
    std::cout << title << (interpolation == Interpolation::linear ? ", linear" : ", half gradient")
              << "\n  rows sum to one to 1e-15: " << yes(defect_of_sums(J) <= 1e-15)
              << "\n  linear field to 1e-13: " << yes(defect_of_linear_field(old_mesh, new_mesh, J) < 1e-13)
              << "\n  transpose to 1e-14: " << yes(defect_of_transpose(J) < 1e-14)
              << "\n  with derivatives to 1e-14: " << yes(defect_of_dual(J) < 1e-14)
              << "\n  positions to 1e-14: " << yes(largest_position_defect(old_mesh, new_mesh, J) < 1e-14)
              << "\n  offset " << (is_plane ? "to 1e-13: " : "below a tenth of h: ")
              << yes(largest_offset(J) < (is_plane ? 1e-13 : 0.5))
              << "\n  weights in [0, 1]: " << (weights_are_convex(J) ? "yes" : "no")
              << "\n  surface from surface: " << yes(surface_rows_stay_on_surface(old_mesh, new_mesh, J))
              << "\n  symmetry kept to 1e-14: "
              << yes(normal_velocity_on_symmetry(old_mesh, new_mesh, J) < 1e-14) << "\n  same bits again: "
              << yes(same_bits(J, make_transfer(old_mesh, old_mesh.X, new_mesh, all_new, interpolation)))
              << std::endl;
  }
}

// New nodes off the old surface, some nearer to other patches than to their own.
void test_shaken(const TetMesh &old_mesh)
{
  RandomNumbers random;
  TetMesh       new_mesh = old_mesh;
  for (Vec3 &x : new_mesh.X)
    x += 1.5 * random.vector();
  const std::vector<NodeIndex> all_new(new_mesh.n_nodes(), invalid_index);
  const auto                   J = make_transfer(old_mesh, old_mesh.X, new_mesh, all_new);
  std::cout << "off the surface\n  surface from surface: "
            << yes(surface_rows_stay_on_surface(old_mesh, new_mesh, J))
            << "\n  linear field to 1e-13: " << yes(defect_of_linear_field(old_mesh, new_mesh, J) < 1e-13)
            << "\n  offset below 3: " << yes(largest_offset(J) < 3) << "\n";
}

// Every tenth node is new (at its old place, off by a little inside), the others moved by less than kept.
void test_kept_nodes(const TetMesh &old_mesh)
{
  RandomNumbers          random;
  TetMesh                new_mesh = old_mesh;
  std::vector<NodeIndex> old_node;
  for (NodeIndex k = 0; k < new_mesh.n_nodes(); ++k)
  {
    old_node.push_back(k % 10 == 0 ? invalid_index : k);
    new_mesh.X[k] += 0.01 * random.vector();
  }
  const auto J           = make_transfer(old_mesh, old_mesh.X, new_mesh, old_node);
  const auto q           = random.scalars(J.n_old);
  const auto transferred = J.apply(q);
  bool       kept        = true;
  double     offset      = 0;
  for (NodeIndex k = 0; k < J.n_new(); ++k)
    if (old_node[k] != invalid_index)
    {
      kept   = kept && transferred[k] == q[k];
      offset = std::max(offset, (J.offset[k] - (new_mesh.X[k] - old_mesh.X[k])).norm());
    }
  std::cout << "kept nodes\n  keep their values: " << yes(kept)
            << "\n  offset is how they moved: " << yes(offset == 0)
            << "\n  J X + c = X': " << yes(largest_position_defect(old_mesh, new_mesh, J) < 1e-14)
            << "\n  bytes per node below 100: " << yes(J.memory_consumption() < 100 * J.n_new()) << "\n";
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  test_location();
  const auto octant = [](const std::string &h) {
    return billet({{"size", "40, 40, 40"},
                   {"element size", h},
                   {"symmetry planes", "-1, 0, 0; 0, -1, 0; 0, 0, 1"},
                   {"symmetry point", "centre"}});
  };
  const auto sector = [](const std::string &h) {
    return billet({{"shape", "cylinder"}, {"element size", h}, {"sector angle", "60"}});
  };
  const TetMesh cube = octant("3");
  test_transfer("eighth of a cube", cube, octant("2.7"), true);
  test_transfer("sector of a cylinder", sector("5"), sector("4"), false);
  test_quadratic(cube, octant("2.7"));
  test_shaken(cube);
  test_kept_nodes(cube);

  TetMesh renamed         = cube;
  renamed.patches[1].name = "other";
  std::vector<NodeIndex> same(cube.n_nodes(), 0);
  print_error("other patches", [&]() { make_transfer(cube, cube.X, renamed, same); });
  print_error("no such node", [&]() {
    same[5] = 100000;
    make_transfer(cube, cube.X, cube, same);
  });
  print_error("values of another mesh", [&]() {
    const auto J = make_transfer(cube, cube.X, cube, std::vector<NodeIndex>(cube.n_nodes(), 0));
    J.apply(std::vector<double>(3, 0.));
  });
}
