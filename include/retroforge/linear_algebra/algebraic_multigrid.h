// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/linear_algebra/types.h>

#include <deal.II/lac/trilinos_precondition.h>

#include <memory>
#include <vector>

namespace retroforge
{
  /// Algebraic multigrid for three unknowns per node: smoothed aggregation with Chebyshev smoothing and a
  /// direct solve on the coarsest level.
  /// @param near_kernel  three vectors of A's local rows, one after the other
  std::unique_ptr<dealii::TrilinosWrappers::PreconditionAMG>
  make_algebraic_multigrid(const Epetra_RowMatrix &A, const std::vector<double> &near_kernel);
} // namespace retroforge
