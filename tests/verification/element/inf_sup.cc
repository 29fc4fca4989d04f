// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The inf-sup constant of both pairs of elements: the root of the smallest eigenvalue, constants aside, of
//   (B^T A^-1 B - C) p = beta^2 M p
// with M the mass matrix of the pressures and v = 0 on the whole boundary of a cube. It must not fall as the
// mesh is refined. That of P2/P1 is decided by cells at the boundary, few of whose velocities are free, and
// scatters with the generator's meshes (0.109 to 0.22 on three): those have a bound, and a series of grids
// must not fall. It begins with five cells to an edge: with three the constant is 0.03. A, B, C are, bubbles
// condensed,
// - the kernels' blocks for K = m = 1, where A is the energy of 2 eps:eps (P2/P1 has no C);
// - of the mini element the same with the norm of the gradient instead, in closed form: a bubble b decouples
// from the linear part and leaves
//   C_cd = -kappa |T| g_c·g_d / sum_a |g_a|^2,  kappa = (mean of b)^2 / (mean of |grad b|^2 / sum_a |g_a|^2):
//   1/64 for the hat, and for the polynomial bubble 256 l1 l2 l3 l4, whose means are 32/105 and 4096/945,
//   3/140.
// Lanczos' method finds it: the largest eigenvalue of the inverse, one solve of the saddle system per step.
// The file `output` holds what is compared.

#include <deal.II/base/mpi.h>
#include <deal.II/lac/tridiagonal_matrix.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <random>

#include <retroforge/mesh/mesh_quality.h>

#include "../../unit/mesh/block_mesh.h"
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
    const double unit  = tet_volume(corners(nodes, mesh.X)) / 20.;
    const double sum   = p[nodes[0]] + p[nodes[1]] + p[nodes[2]] + p[nodes[3]];
    for (const NodeIndex k : nodes)
      y[k] += unit * (sum + p[k]);
  }
  return y;
}

/// The cell's blocks, from its geometry.
using Blocks = std::function<CellSystem(const CellGeometry<double> &)>;

template <typename Values>
CellSystem energy_blocks(const CellGeometry<double> &geometry)
{
  return cell_system(tangent_of(geometry, Values{}, NortonHoff<double>{1., 1., 0.}), Values{});
}

CellSystem gradient_blocks(const CellGeometry<double> &geometry, const double kappa)
{
  const auto  &g = geometry.g;
  CellSystem   system(4);
  const double sum = g[0] * g[0] + g[1] * g[1] + g[2] * g[2] + g[3] * g[3];
  for (unsigned int a = 0; a < 4; ++a)
    for (unsigned int b = 0; b < 4; ++b)
    {
      const double gg = geometry.volume * (g[a] * g[b]);
      for (unsigned int i = 0; i < 3; ++i)
      {
        system.matrix(3 * a + i, 3 * b + i) = gg;
        system.matrix(3 * a + i, 12 + b)    = -0.25 * geometry.volume * g[a][i];
        system.matrix(12 + b, 3 * a + i)    = -0.25 * geometry.volume * g[a][i];
      }
      system.matrix(12 + a, 12 + b) = -kappa * gg / sum;
    }
  return system;
}

class SchurComplement
{
public:
  SchurComplement(const TetMesh &mesh, const Discretization<3> &discretization, const Blocks &blocks)
      : unknowns_(discretization), system_(mesh, unknowns_, held(mesh, discretization))
  {
    system_.assemble([&](const CellIndex c) { return blocks(geometry_of_cell(discretization, mesh.X, c)); });
  }

  /// p of  (B^T A^-1 B - C) p = r  up to a constant, for r orthogonal to constants.
  Pressures solve(const Pressures &r)
  {
    std::vector<double> rhs(unknowns_.size(), 0.);
    for (std::size_t k = 0; k < r.size(); ++k)
      rhs[unknowns_.pressure(k)] = -r[k];
    const std::vector<double> x = system_.solve(rhs);
    Pressures                 p(r.size());
    for (std::size_t k = 0; k < r.size(); ++k)
      p[k] = x[unknowns_.pressure(k)];
    return p;
  }

private:
  /// All boundary velocities, and one pressure for the constant.
  static std::vector<char> held(const TetMesh &mesh, const Discretization<3> &discretization)
  {
    std::vector<char> fixed                     = held_velocities(mesh, discretization, "none");
    fixed[Unknowns(discretization).pressure(0)] = 1;
    return fixed;
  }

  Unknowns     unknowns_;
  GlobalSystem system_;
};

double inf_sup_constant(const TetMesh &mesh, const ElementPair pair, const Blocks &blocks)
{
  const Discretization<3> discretization(mesh, {pair}, MPI_COMM_SELF);
  SchurComplement         schur(mesh, discretization, blocks);
  const Pressures         ones(mesh.n_nodes(), 1.), M_ones = times_mass(mesh, ones);
  const double            volume = dot(ones, M_ones);

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

std::vector<TetMesh> generated(const std::vector<double> &sizes)
{
  std::vector<TetMesh> meshes;
  for (const double size : sizes)
    meshes.push_back(unit_cube(size));
  return meshes;
}

/// Of n x n x n blocks each.
std::vector<TetMesh> grids(const std::vector<unsigned int> &numbers)
{
  std::vector<TetMesh> meshes;
  for (const unsigned int n : numbers)
  {
    meshes.push_back(block_mesh({{n, n, n}}, [](unsigned int, unsigned int, unsigned int) { return true; }));
    for (Vec3 &x : meshes.back().X)
      x /= n;
  }
  return meshes;
}

/// On ever finer meshes.
std::vector<double> inf_sup_constants(const std::string          &name,
                                      const ElementPair           pair,
                                      const Blocks               &blocks,
                                      const std::vector<TetMesh> &meshes,
                                      const double                bar,
                                      std::ostream               &output)
{
  std::vector<double> constants;
  for (const TetMesh &mesh : meshes)
  {
    constants.push_back(inf_sup_constant(mesh, pair, blocks));
    std::cout << name << ", " << mesh.n_nodes() << " nodes: " << constants.back() << std::endl;
  }
  const double smallest = *std::min_element(constants.begin(), constants.end());
  std::cout << "FIGURE inf_sup_" << name << "_smallest " << smallest << std::endl;
  output << name << std::endl
         << "  above " << bar << " on every mesh: " << (smallest > bar ? "yes" : "NO") << std::endl;
  return constants;
}

void check_mini(const std::string &name, const Blocks &blocks, const double bar, std::ostream &output)
{
  const auto constants =
    inf_sup_constants(name, ElementPair::mini, blocks, generated({1. / 4., 1. / 7., 1. / 12.}), bar, output);
  const auto [smallest, largest] = std::minmax_element(constants.begin(), constants.end());
  std::cout << "FIGURE inf_sup_" << name << "_spread " << *largest / *smallest << std::endl;
  output << "  flat within a fifth: " << (*largest / *smallest < 1.2 ? "yes" : "NO") << std::endl;
}

void check_taylor_hood(std::ostream &output)
{
  const auto &blocks  = energy_blocks<TaylorHoodValues<double>>;
  const auto  of_pair = ElementPair::taylor_hood;
  const auto  sizes   = {1. / 5., 1. / 8., 1. / 11.};
  inf_sup_constants("quadratic", of_pair, blocks, generated(sizes), 0.1, output);
  const auto constants = inf_sup_constants("quadratic_grid", of_pair, blocks, grids({5, 7, 9}), 0.1, output);
  bool       falls     = false;
  for (std::size_t i = 1; i < constants.size(); ++i)
    falls = falls || constants[i] < 0.95 * constants[i - 1];
  output << "  does not fall by a twentieth from mesh to mesh: " << (falls ? "NO" : "yes") << std::endl;
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  std::ofstream                            output("output");
  using Geometry      = CellGeometry<double>;
  const auto gradient = [](const double kappa) {
    return [kappa](const Geometry &g) { return gradient_blocks(g, kappa); };
  };
  check_mini("energy_norm", energy_blocks<CellValues<double>>, 0.09, output);
  check_mini("gradient_norm", gradient(1. / 64.), 0.1, output);
  check_mini("polynomial_bubble", gradient(3. / 140.), 0.12, output);
  check_taylor_hood(output);
}
