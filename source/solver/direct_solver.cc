// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/solver/direct_solver.h>

#include <Amesos_Mumps.h>
#include <Epetra_LinearProblem.h>

#include <cmath>
#include <iostream>
#include <memory>

namespace retroforge
{
  namespace
  {
    /// What MUMPS answers: INFOG(1), which is negative where it failed, and INFOG(2).  See its manual.
    struct Answer
    {
      int status, detail;

      bool lacks_workspace() const { return status == -8 || status == -9; }
      bool lacks_memory() const { return status == -13 || status == -7 || status == -5; }
    };

    /// Amesos prints the failures of MUMPS, which are ours to tell.
    class SilentErrors
    {
    public:
      SilentErrors() : buffer_(std::cerr.rdbuf(nullptr)) {}
      ~SilentErrors()
      {
        std::cerr.rdbuf(buffer_);
        std::cerr.clear();
      }
      SilentErrors(const SilentErrors &)            = delete;
      SilentErrors &operator=(const SilentErrors &) = delete;

    private:
      std::streambuf *buffer_;
    };

    Answer solve_once(const Epetra_LinearProblem &problem, const int spare, MPI_Comm comm)
    {
      const SilentErrors silent;
      Amesos_Mumps       mumps(problem);
      mumps.SetICNTL(14, spare);
      if (mumps.SymbolicFactorization() == 0 && mumps.NumericFactorization() == 0)
        mumps.Solve();
      Answer answer{mumps.GetINFOG()[0], mumps.GetINFOG()[1]};
      MPI_Bcast(&answer, 2, MPI_INT, 0, comm);
      return answer;
    }

    [[noreturn]] void throw_failure(const Answer &answer)
    {
      if (answer.lacks_workspace() || answer.lacks_memory())
        throw Error("Linear solver",
                    "MUMPS has not enough memory (INFOG(1) = " + std::to_string(answer.status) + ")",
                    "the factors of a direct solve must fit into memory",
                    "use a coarser mesh or more ranks on more machines, or Linear solver/method = ilu");
      throw NoLinearSolution("Linear solver",
                             "finds no solution (MUMPS: INFOG(1) = " + std::to_string(answer.status) +
                               ", INFOG(2) = " + std::to_string(answer.detail) + ")",
                             "a linear system must be regular, its numbers within the range of doubles",
                             "use values of the usual size: penalties and friction above all");
    }

    bool is_finite(const dealii::TrilinosWrappers::MPI::Vector &x)
    {
      return std::isfinite(x.l2_norm());
    }
  } // namespace

  unsigned int solve_by_mumps(const dealii::TrilinosWrappers::SparseMatrix &A,
                              const dealii::TrilinosWrappers::MPI::Vector  &b,
                              dealii::TrilinosWrappers::MPI::Vector        &x,
                              int                                           spare)
  {
    const Epetra_LinearProblem problem(const_cast<Epetra_CrsMatrix *>(&A.trilinos_matrix()),
                                       &x.trilinos_vector(),
                                       const_cast<Epetra_MultiVector *>(&b.trilinos_vector()));
    constexpr int              most = 2000;
    for (unsigned int calls = 1;; ++calls, spare = std::max(100, 3 * spare))
    {
      const Answer answer = solve_once(problem, spare, A.get_mpi_communicator());
      if (answer.status >= 0 && is_finite(x))
        return calls;
      if (!answer.lacks_workspace() || spare > most)
        throw_failure(answer);
    }
  }
} // namespace retroforge
