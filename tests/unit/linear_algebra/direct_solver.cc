// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Systems solved by MUMPS, on one rank and on two. Proved:
// - the equations of a string under load with multipliers, as large as those of a small billet, are solved;
// - with less memory than pivoting takes, MUMPS fails (INFOG(1) = -9), is called again with more, and solves
//   them;
// - a system without a solution, and one that holds infinity, end in NoLinearSolution, and nothing else is
//   printed.

#include <deal.II/base/mpi.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <retroforge/linear_algebra/direct_solver.h>

#include <cmath>
#include <iostream>
#include <limits>

using namespace retroforge;
using namespace dealii;

namespace
{
  constexpr unsigned int n = 4000;

  /// A saddle point: every fourth unknown is a multiplier with nothing on its diagonal.
  struct System
  {
    IndexSet                       rows{n};
    TrilinosWrappers::SparseMatrix A;
    TrilinosWrappers::MPI::Vector  b, x;

    /// Past deal.II, which asserts that numbers are finite.
    void put(const int row, const int column, const double value)
    {
      const_cast<Epetra_CrsMatrix &>(A.trilinos_matrix()).ReplaceGlobalValues(row, 1, &value, &column);
    }

    explicit System(const double coupling)
    {
      const unsigned int rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD),
                         all  = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
      rows.add_range(rank * n / all, (rank + 1) * n / all);
      TrilinosWrappers::SparsityPattern pattern(rows, MPI_COMM_WORLD, 40);
      for (const auto i : rows)
      {
        pattern.add(i, i);
        for (const unsigned int j : neighbours(i))
          pattern.add(i, j);
      }
      pattern.compress();
      A.reinit(pattern);
      b.reinit(rows, MPI_COMM_WORLD);
      x.reinit(rows, MPI_COMM_WORLD);
      for (const auto i : rows)
      {
        if (i % 4 != 3)
          A.set(i, i, 1e-3);
        for (const unsigned int j : neighbours(i))
          put(i, j, coupling / (1. + std::min((i + n - j) % n, (j + n - i) % n)));
        b[i] = 1. + i % 7;
      }
      A.compress(VectorOperation::insert);
      b.compress(VectorOperation::insert);
    }

    /// Near and far, so that elimination fills the matrix.
    static std::vector<unsigned int> neighbours(const unsigned int i)
    {
      std::vector<unsigned int> found;
      for (unsigned int step = 1; step < 400; step = 2 * step + 1)
        found.insert(found.end(), {(i + step) % n, (i + n - step) % n});
      return found;
    }

    void solve(const std::string &what, const int spare)
    {
      x = 0.;
      try
      {
        const unsigned int            calls = solve_by_mumps(A, b, x, Transposition::plain, spare);
        TrilinosWrappers::MPI::Vector r(b);
        const double                  residual = A.residual(r, x, b) / b.l2_norm();
        if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
          std::cout << what << ": solved below 1e-9: " << (residual < 1e-9)
                    << ", in more than one call: " << (calls > 1) << std::endl;
      }
      catch (const NoLinearSolution &failure)
      {
        if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
          std::cout << what << ": " << std::string(failure.what()).substr(0, 33) << std::endl;
      }
    }
  };
} // namespace

int main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  System                           sound(1.);
  sound.solve("with room", 1000);
  sound.solve("with too little", -95);
  System(0.).solve("singular", 20);
  System(std::numeric_limits<double>::infinity()).solve("infinite", 20);
}
