// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/error.h>

#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_vector.h>

namespace retroforge
{
  /// A linear system has no solution in doubles: it is singular, or its numbers have left their range.
  struct NoLinearSolution : Error
  {
    using Error::Error;
  };

  /// x = A^(-1) b by MUMPS. How much memory pivoting takes is known only once it is done: where the estimate
  /// was too small, MUMPS is called again with more. Collective.
  /// @param spare  memory beyond the estimate at first, per cent of it
  /// @return how often MUMPS was called
  /// @throws NoLinearSolution
  /// @throws Error  where there is not enough memory
  unsigned int solve_by_mumps(const dealii::TrilinosWrappers::SparseMatrix &A,
                              const dealii::TrilinosWrappers::MPI::Vector  &b,
                              dealii::TrilinosWrappers::MPI::Vector        &x,
                              int                                           spare = 20);
} // namespace retroforge
