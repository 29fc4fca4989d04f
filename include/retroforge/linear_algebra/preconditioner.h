// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/linear_algebra/blocked_matrix.h>

#include <deal.II/lac/trilinos_precondition.h>

#include <memory>
#include <vector>

namespace retroforge
{
  /// Block triangular preconditioner  [A B; 0 -S]^(-1)  of the saddle system [A B; D C]: A by incomplete
  /// factorisation or multigrid, S (positive, nearly D A^(-1) B - C) by incomplete factorisation.
  class Preconditioner
  {
  public:
    /// @param near_kernel    three vectors of A's local rows, one after the other (rigid translations), for
    /// multigrid
    /// @param interpolation  from linear to quadratic velocities, for multigrid; null where A's are linear
    Preconditioner(const BlockedMatrix       &A,
                   const BlockedMatrix       &B,
                   const la::SparseMatrix    &D,
                   const la::SparseMatrix    &S,
                   bool                       multigrid,
                   const std::vector<double> &near_kernel,
                   const la::SparseMatrix    *interpolation);

    void vmult(la::BlockVector &z, const la::BlockVector &r) const;

    /// Applies the preconditioner of the transposed system,  [A^T D^T; 0 -S^T]^(-1),  with what approximates
    /// A and S as it is: most of both is symmetric.
    void Tvmult(la::BlockVector &z, const la::BlockVector &r) const;

  private:
    const BlockedMatrix                                        &B_;
    const la::SparseMatrix                                     &D_;
    std::unique_ptr<dealii::TrilinosWrappers::PreconditionBase> A_;
    dealii::TrilinosWrappers::PreconditionILU                   S_;
    mutable la::Vector                                          momentum_;
  };
} // namespace retroforge
