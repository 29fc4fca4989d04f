// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/linear_algebra/algebraic_multigrid.h>
#include <retroforge/linear_algebra/chebyshev_smoother.h>

namespace retroforge
{
  /// One cycle for the matrix A of a quadratic space: correction in the linear space, whose matrix is P^T A
  /// P, by algebraic multigrid, and smoothing. Nothing is smoothed before: that would not be symmetric, but
  /// flexible GMRES does not ask for it, and it is the best of what as many products with A can do.
  class PMultigrid : public dealii::TrilinosWrappers::PreconditionBase
  {
  public:
    /// @param P            interpolation from the linear space; must live as long, like A, and not change
    /// @param near_kernel  three vectors of A's local rows, one after the other; the unknowns of the linear
    /// space come first among them
    PMultigrid(const la::SparseMatrix &A, const la::SparseMatrix &P, const std::vector<double> &near_kernel);

    void vmult(la::Vector &z, const la::Vector &r) const override;

  private:
    const la::SparseMatrix                                    &P_;
    ChebyshevSmoother                                          smoother_;
    la::SparseMatrix                                           linear_;
    std::unique_ptr<dealii::TrilinosWrappers::PreconditionAMG> of_linear_;
    mutable la::Vector                                         linear_r_, linear_z_;
  };
} // namespace retroforge
