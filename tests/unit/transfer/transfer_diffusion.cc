// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// How much a Gaussian  exp(-|x|^2 / (2h)^2)  inside a box of edge 10 h loses over repeated
// remeshings: relative L2 error (lumped) of its nodal values after 10, 30 and 60 transfers. Two ways of
// remeshing: rebuilding, back and forth between two unrelated meshes; and local, 3 % of the nodes moved by up
// to 0.3 h from where the first mesh has them. Beside it the lowest value met, and how much is left of the
// lumped L2 norm of a random field around it. A transfer that amplifies shows there: the whole correction by
// gradients instead of half of it makes the norm 2000 times as large. Of a single value this cannot be asked,
// as rows have negative weights.
// Proved: local remeshing loses 0.2 times as much as rebuilding or less; half the gradient correction loses
// 0.5 times as much or less; its undershoot stays below 2.5 % of the peak (1 % local); nothing is amplified.
// With an argument, h instead of 4, the numbers are printed.

#include <deal.II/base/mpi.h>

#include "../mesh/mesh_test_tools.h"
#include <retroforge/mesh/boundary_location.h>
#include <retroforge/mesh/topology.h>
#include <retroforge/transfer/transfer.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <iomanip>
#include <random>
#include <sstream>

using namespace retroforge;

double h = 4;

// Not the middle of the box: Gmsh puts a node there in every mesh, which would keep its value.
const Vec3 centre({3, -2, 18.5});

double gaussian(const Vec3 &x)
{
  return std::exp(-(x - centre).norm_square() / (4 * h * h));
}

std::vector<double> lumped_mass(const TetMesh &mesh)
{
  std::vector<double> mass(mesh.n_nodes(), 0.);
  for (const auto &cell : mesh.cells)
    for (const NodeIndex node : cell)
      mass[node] += tet_volume(corners(cell, mesh.X)) / 4;
  return mass;
}

std::vector<double> initial(const TetMesh &mesh)
{
  std::vector<double> q;
  for (const Vec3 &x : mesh.X)
    q.push_back(gaussian(x));
  return q;
}

std::vector<double> random_values(const std::size_t n)
{
  std::mt19937        generator(2);
  std::vector<double> values(n);
  for (double &value : values)
    value = 2. * (generator() / 4294967295.) - 1.;
  return values;
}

double relative_error(const TetMesh &mesh, const std::vector<double> &q)
{
  const auto mass = lumped_mass(mesh), exact = initial(mesh);
  double     error = 0, size = 0;
  for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
  {
    error += mass[k] * (q[k] - exact[k]) * (q[k] - exact[k]);
    size += mass[k] * exact[k] * exact[k];
  }
  return std::sqrt(error / size);
}

/// What 60 transfers leave of the Gaussian, and of values in [-1, 1] drawn by chance.
struct Loss
{
  std::array<double, 3> errors; ///< relative, after 10, 30, 60
  double                lowest; ///< value of the Gaussian, which has none below 0
  double                noise;  ///< norm of the random values after the last, over that at first
};

/// Lumped L2 norm around the Gaussian: corners of the box keep their values for ever.
double norm_around(const TetMesh &mesh, const std::vector<double> &r)
{
  const auto mass = lumped_mass(mesh);
  double     sum  = 0;
  for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
    if ((mesh.X[k] - centre).norm() < 10)
      sum += mass[k] * r[k] * r[k];
  return std::sqrt(sum);
}

using Transfers = std::function<const TransferOperator &()>; // from one mesh to the next

/// @param mesh  where the last transfer led to
Loss repeat(const TetMesh &first, const TetMesh *const &mesh, const Transfers &next)
{
  Loss         loss  = {};
  auto         q     = initial(first);
  auto         r     = random_values(first.n_nodes());
  const double noise = norm_around(first, r);
  unsigned int n     = 0;
  for (unsigned int i = 1; i <= 60; ++i)
  {
    const TransferOperator &J = next();
    q                         = J.apply(q);
    r                         = J.apply(r);
    loss.lowest               = std::min(loss.lowest, *std::min_element(q.begin(), q.end()));
    if (i == 10 || i == 30 || i == 60)
      loss.errors[n++] = relative_error(*mesh, q);
  }
  loss.noise = norm_around(*mesh, r) / noise;
  return loss;
}

Loss rebuilding(const TetMesh &a, const TetMesh &b, const Interpolation interpolation)
{
  const auto to_b =
    make_transfer(a, a.X, b, std::vector<NodeIndex>(b.n_nodes(), invalid_index), interpolation);
  const auto to_a =
    make_transfer(b, b.X, a, std::vector<NodeIndex>(a.n_nodes(), invalid_index), interpolation);
  const TetMesh *mesh = &a;
  return repeat(a, mesh, [&]() -> const TransferOperator & {
    mesh = mesh == &a ? &b : &a;
    return mesh == &b ? to_b : to_a;
  });
}

bool is_sound(const TetMesh &mesh, const Topology &topology, const NodeIndex node)
{
  for (const CellIndex c : topology.cells[node])
    if (tet_quality(corners(mesh.cells[c], mesh.X)) < 0.05)
      return false;
  return true;
}

// Inner nodes are drawn by chance, moved from where the first mesh has them, and undone if that spoils a
// cell.
Loss moving(const TetMesh &first, const Interpolation interpolation)
{
  std::mt19937                           generator(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  const Topology                         topology(first);
  const auto                             patches = patches_at_nodes(first);
  TetMesh                                mesh    = first;
  const TetMesh                         *current = &mesh;
  TransferOperator                       J;
  return repeat(first, current, [&]() -> const TransferOperator & {
    TetMesh                next = mesh;
    std::vector<NodeIndex> old_node(mesh.n_nodes());
    for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
    {
      old_node[k] = k;
      if (unit(generator) > 0.94 && patches[k].empty())
      {
        const Vec3 move({unit(generator), unit(generator), unit(generator)});
        next.X[k] = first.X[k] + 0.3 * h / std::max(1., move.norm()) * move;
        if (is_sound(next, topology, k))
          old_node[k] = invalid_index;
        else
          next.X[k] = mesh.X[k];
      }
    }
    J    = make_transfer(mesh, mesh.X, next, old_node, interpolation);
    mesh = next;
    return J;
  });
}

std::string element_size(const double size)
{
  std::ostringstream out;
  out << size;
  return out.str();
}

void report(const std::string &title, const Loss &loss)
{
  std::cout << "  " << title << ":";
  for (const double error : loss.errors)
    std::cout << " " << error;
  std::cout << ", lowest value " << loss.lowest << ", random field " << loss.noise << std::endl;
}

bool loses_less(const Loss &a, const double factor, const Loss &b)
{
  for (unsigned int i = 0; i < 3; ++i)
    if (!(a.errors[i] < factor * b.errors[i]))
      return false;
  return true;
}

void report_cost(const TetMesh &a, const TetMesh &b)
{
  std::cout << a.n_nodes() << " and " << b.n_nodes() << " nodes\n";
  for (const auto interpolation : {Interpolation::linear, Interpolation::half_gradient})
  {
    const auto start = std::chrono::steady_clock::now();
    const auto J =
      make_transfer(a, a.X, b, std::vector<NodeIndex>(b.n_nodes(), invalid_index), interpolation);
    const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - start;
    std::cout << "per new node: " << time.count() / b.n_nodes() << " us, "
              << static_cast<double>(J.memory_consumption()) / b.n_nodes() << " bytes, "
              << static_cast<double>(J.node.size()) / b.n_nodes() << " entries\n";
  }
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (argc > 1)
    h = std::atof(argv[1]);
  const auto box = [&](const double size) {
    return billet({{"size", "40, 40, 40"}, {"element size", element_size(size)}});
  };
  const TetMesh a = box(h), b = box(0.93 * h);
  const Loss    rebuilt  = rebuilding(a, b, Interpolation::linear);
  const Loss    better   = rebuilding(a, b, Interpolation::half_gradient);
  const Loss    moved    = moving(a, Interpolation::linear);
  const Loss    improved = moving(a, Interpolation::half_gradient);
  if (argc > 1)
  {
    report_cost(a, b);
    report("rebuilding, linear", rebuilt);
    report("rebuilding, half gradient", better);
    report("3 % moved, linear", moved);
    report("3 % moved, half gradient", improved);
  }
  std::cout << "a local remeshing loses less than 0.2 times as much: " << yes(loses_less(moved, 0.2, rebuilt))
            << "\nhalf the gradient loses less than 0.5 times as much, rebuilding: "
            << yes(loses_less(better, 0.5, rebuilt)) << ", local: " << yes(loses_less(improved, 0.5, moved))
            << "\nno undershoot when linear: " << yes(rebuilt.lowest == 0 && moved.lowest == 0)
            << "\nits undershoot is there, rebuilding below 2.5 %: "
            << yes(better.lowest < 0 && better.lowest > -0.025)
            << ", local below 1 %: " << yes(improved.lowest > -0.01)
            << "\nnothing amplified: " << yes(better.noise < 1 && improved.noise < 1) << "\n";
}
