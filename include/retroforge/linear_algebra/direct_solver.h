// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/error.h>

#include <retroforge/linear_algebra/types.h>

#include <utility>
#include <vector>

namespace retroforge
{
  /// A linear system has no solution in doubles: it is singular, or its numbers have left their range.
  struct NoLinearSolution : Error
  {
    using Error::Error;
  };

  /// x = A^(-1) b, or A^(-T) b, by MUMPS. How much memory pivoting takes is known only once it is done: where
  /// the estimate was too small, MUMPS is called again with more. Collective.
  /// @param spare  memory beyond the estimate at first, per cent of it
  /// @return how often MUMPS was called
  /// @throws NoLinearSolution
  /// @throws Error  where there is not enough memory
  unsigned int solve_by_mumps(const la::SparseMatrix &A,
                              const la::Vector       &b,
                              la::Vector             &x,
                              Transposition           transposition = Transposition::plain,
                              int                     spare         = 20);

  /// Solves a system with a matrix of blocks, to the first of which products row x column are added. They stand
  /// in rows and columns of their own: [A row; column -1].
  unsigned int solve_by_mumps(const la::BlockSparseMatrix &A,
                              const la::BlockVector       &b,
                              la::BlockVector             &x,
                              Transposition                transposition = Transposition::plain,
                              const std::vector<std::pair<la::Vector, la::Vector>> &products = {});
} // namespace retroforge
