// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/linear_algebra/node_blocks.h>

namespace retroforge
{
  /// Damps the errors that an interpolation from a coarser space cannot represent: three steps of Chebyshev's
  /// iteration with the matrix over its diagonal D, for the upper nine tenths of its spectrum. Works in
  /// single precision on a copy of 3 x 3 blocks: a smoother has to read the matrix, not to be exact, and this
  /// is a third of the memory.
  class ChebyshevSmoother
  {
  public:
    /// @param A  rows and columns in threes (NodeMatrix); must live as long, and not change
    explicit ChebyshevSmoother(const la::SparseMatrix &A);

    /// Improves z as a solution of A z = r.
    void smooth(la::Vector &z, const la::Vector &r) const;

  private:
    void take_diagonal();
    /// Returns an estimate from below of the largest eigenvalue of D^(-1) A, by the power method.
    float largest_eigenvalue() const;
    /// defect_ = D^(-1) (r - A z)
    void compute_defect() const;
    /// Completes z_ by what other ranks own.
    void fetch_columns() const;

    const la::SparseMatrix    &A_;
    unsigned int               n_rows_; ///< this rank's
    NodeBlocks<float>          blocks_;
    std::vector<float>         inverse_diagonal_;
    float                      largest_ = 1.;
    mutable std::vector<float> z_, r_, defect_, change_;
  };
} // namespace retroforge
