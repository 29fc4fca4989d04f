// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The inf-sup constant of the mini element: the root of the smallest eigenvalue, constants aside, of
//   (B^T A^-1 B - C) p = beta^2 M p
// with the kernels' blocks for K = m = 1 (A is the energy of 2 eps:eps, bubbles condensed), M the mass matrix of the
// pressures, and v = 0 on the whole boundary of a cube. It must not fall as the mesh is refined. Lanczos' method finds
// it: the largest eigenvalue of the inverse, one solve of the saddle system per step.
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

class SchurComplement
{
public:
  explicit SchurComplement(const TetMesh &mesh)
    : mesh_(mesh)
    , system_(mesh, held(mesh))
  {
    const NortonHoff<double> law{1., 1., 0.};
    system_.assemble([&](const CellIndex c) {
      CellTangent t;
      compute_cell_tangent(cell_geometry(positions_of_cell(mesh, mesh.X, c)), {}, law, t);
      return condensed_system(t, {});
    });
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

  const TetMesh &mesh_;
  NodalSystem    system_;
};

double inf_sup_constant(const TetMesh &mesh)
{
  SchurComplement schur(mesh);
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

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  std::ofstream                            output("output");
  double                                   smallest = 1e300, largest = 0.;
  for (const double size : {1. / 4., 1. / 7., 1. / 12.})
    {
      const TetMesh mesh = unit_cube(size);
      const double  beta = inf_sup_constant(mesh);
      std::cout << mesh.n_nodes() << " nodes: " << beta << std::endl;
      smallest = std::min(smallest, beta);
      largest  = std::max(largest, beta);
    }
  std::cout << "FIGURE inf_sup_smallest " << smallest << std::endl
            << "FIGURE inf_sup_largest_over_smallest " << largest / smallest << std::endl;
  output << "above 0.1 on every mesh: " << (smallest > 0.1 ? "yes" : "NO") << std::endl
         << "flat within a quarter: " << (largest / smallest < 1.25 ? "yes" : "NO") << std::endl;
}
