// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The inf-sup constant of the mini element: the root of the smallest eigenvalue, constants aside, of
//   (B^T A^-1 B - C) p = beta^2 M p
// with M the mass matrix of the pressures and v = 0 on the whole boundary of a cube. It must not fall as the
// mesh is refined. A, B, C are, bubbles condensed,
// - the kernels' blocks for K = m = 1, where A is the energy of 2 eps:eps;
// - the same with the norm of the gradient instead, in closed form: a bubble b decouples from the linear part
// and leaves
//   C_cd = -kappa |T| g_c·g_d / sum_a |g_a|^2,  kappa = (mean of b)^2 / (mean of |grad b|^2 / sum_a |g_a|^2):
//   1/64 for the hat, and for the polynomial bubble 256 l1 l2 l3 l4, whose means are 32/105 and 4096/945,
//   3/140.
// Lanczos' method finds it: the largest eigenvalue of the inverse, one solve of the saddle system per step.
// The file `output` holds what is compared.

#include <deal.II/base/mpi.h>
#include <deal.II/lac/tridiagonal_matrix.h>

#include <fstream>
#include <iostream>
#include <random>

#include "flow_problem.h"

using namespace retroforge;
using Pressures = std::vector<double>;

double dot(const Pressures &a, const Pressures &b)
{
  double sum = 0.;
  for (std::size_t k = 0; k < a.size(); ++k)
    sum += a[k] * b[k];
  return sum;
}

void add(Pressures &a, const double factor, const Pressures &b)
{
  for (std::size_t k = 0; k < a.size(); ++k)
    a[k] += factor * b[k];
}

Pressures times_mass(const TetMesh &mesh, const Pressures &p)
{
  Pressures y(p.size(), 0.);
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
  {
    const auto  &nodes = mesh.cells[c];
    const double unit  = cell_geometry(positions_of_cell(mesh, mesh.X, c)).volume / 20.;
    const double sum   = p[nodes[0]] + p[nodes[1]] + p[nodes[2]] + p[nodes[3]];
    for (const NodeIndex k : nodes)
      y[k] += unit * (sum + p[k]);
  }
  return y;
}

/// The cell's blocks, from its geometry.
using Blocks = std::function<CellSystem(const CellGeometry<double> &)>;

CellSystem energy_blocks(const CellGeometry<double> &geometry)
{
  CellTangent t;
  compute_cell_tangent(geometry, {}, NortonHoff<double>{1., 1., 0.}, t);
  return condensed_system(t, {});
}

CellSystem gradient_blocks(const CellGeometry<double> &geometry, const double kappa)
{
  const auto  &g      = geometry.g;
  CellSystem   system = {};
  const double sum    = g[0] * g[0] + g[1] * g[1] + g[2] * g[2] + g[3] * g[3];
  for (unsigned int a = 0; a < 4; ++a)
    for (unsigned int b = 0; b < 4; ++b)
    {
      const double gg = geometry.volume * (g[a] * g[b]);
      for (unsigned int i = 0; i < 3; ++i)
      {
        system.matrix[4 * a + i][4 * b + i] = gg;
        system.matrix[4 * a + i][4 * b + 3] = -0.25 * geometry.volume * g[a][i];
        system.matrix[4 * b + 3][4 * a + i] = -0.25 * geometry.volume * g[a][i];
      }
      system.matrix[4 * a + 3][4 * b + 3] = -kappa * gg / sum;
    }
  return system;
}

class SchurComplement
{
public:
  SchurComplement(const TetMesh &mesh, const Blocks &blocks) : system_(mesh, held(mesh))
  {
    system_.assemble(
      [&](const CellIndex c) { return blocks(cell_geometry(positions_of_cell(mesh, mesh.X, c))); });
  }

  /// p of  (B^T A^-1 B - C) p = r  up to a constant, for r orthogonal to constants.
  Pressures solve(const Pressures &r)
  {
    std::vector<double> rhs(4 * r.size(), 0.);
    for (std::size_t k = 0; k < r.size(); ++k)
      rhs[4 * k + 3] = -r[k];
    const std::vector<double> x = system_.solve(rhs);
    Pressures                 p(r.size());
    for (std::size_t k = 0; k < r.size(); ++k)
      p[k] = x[4 * k + 3];
    return p;
  }

private:
  /// All boundary velocities, and one pressure for the constant.
  static std::vector<char> held(const TetMesh &mesh)
  {
    std::vector<char> fixed = held_velocities(mesh, "none");
    fixed[3]                = 1;
    return fixed;
  }

  NodalSystem system_;
};

double inf_sup_constant(const TetMesh &mesh, const Blocks &blocks)
{
  SchurComplement schur(mesh, blocks);
  const Pressures ones(mesh.n_nodes(), 1.), M_ones = times_mass(mesh, ones);
  const double    volume = dot(ones, M_ones);

  std::mt19937           generator(1);
  Pressures              p(mesh.n_nodes());
  std::vector<Pressures> basis, M_basis;
  std::vector<double>    diagonal, off_diagonal;
  for (double &x : p)
    x = generator() / 4294967295. - 0.5;
  const unsigned int n_steps = 60;
  for (unsigned int step = 0; step < n_steps; ++step)
  {
    add(p, -dot(p, M_ones) / volume, ones);
    for (unsigned int pass = 0; pass < 2; ++pass)
      for (std::size_t j = 0; j < basis.size(); ++j)
        add(p, -dot(p, M_basis[j]), basis[j]);
    Pressures    Mp   = times_mass(mesh, p);
    const double norm = std::sqrt(dot(p, Mp));
    off_diagonal.push_back(norm);
    for (std::size_t k = 0; k < p.size(); ++k)
    {
      p[k] /= norm;
      Mp[k] /= norm;
    }
    basis.push_back(p);
    M_basis.push_back(Mp);
    p = schur.solve(Mp);
    diagonal.push_back(dot(p, Mp));
  }
  dealii::TridiagonalMatrix<double> T(n_steps, true);
  for (unsigned int j = 0; j < n_steps; ++j)
  {
    T(j, j) = diagonal[j];
    if (j > 0)
      T(j, j - 1) = off_diagonal[j];
  }
  T.compute_eigenvalues();
  return 1. / std::sqrt(T.eigenvalue(n_steps - 1));
}

void check(const std::string &name, const Blocks &blocks, const double bar, std::ostream &output)
{
  double smallest = 1e300, largest = 0.;
  for (const double size : {1. / 4., 1. / 7., 1. / 12.})
  {
    const TetMesh mesh = unit_cube(size);
    const double  beta = inf_sup_constant(mesh, blocks);
    std::cout << name << ", " << mesh.n_nodes() << " nodes: " << beta << std::endl;
    smallest = std::min(smallest, beta);
    largest  = std::max(largest, beta);
  }
  std::cout << "FIGURE inf_sup_" << name << "_smallest " << smallest << std::endl
            << "FIGURE inf_sup_" << name << "_spread " << largest / smallest << std::endl;
  output << name << std::endl
         << "  above " << bar << " on every mesh: " << (smallest > bar ? "yes" : "NO") << std::endl
         << "  flat within a fifth: " << (largest / smallest < 1.2 ? "yes" : "NO") << std::endl;
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  std::ofstream                            output("output");
  using Geometry = CellGeometry<double>;
  check("energy_norm", energy_blocks, 0.09, output);
  check(
    "gradient_norm", [](const Geometry &g) { return gradient_blocks(g, 1. / 64.); }, 0.1, output);
  check(
    "polynomial_bubble", [](const Geometry &g) { return gradient_blocks(g, 3. / 140.); }, 0.12, output);
}
