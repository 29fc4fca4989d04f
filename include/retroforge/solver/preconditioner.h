// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/lac/trilinos_block_sparse_matrix.h>
#include <deal.II/lac/trilinos_parallel_block_vector.h>
#include <deal.II/lac/trilinos_precondition.h>

namespace retroforge
{
  /// Block triangular preconditioner  [A B; 0 -S]^(-1)  of the saddle system: A by incomplete factorisation
  /// or algebraic multigrid, S (positive) by incomplete factorisation.
  class Preconditioner
  {
  public:
    using BlockVector = dealii::TrilinosWrappers::MPI::BlockVector;
    using Vector      = dealii::TrilinosWrappers::MPI::Vector;
    using Matrix      = dealii::TrilinosWrappers::SparseMatrix;

    /// @param near_kernel  three vectors of A's local rows, one after the other (rigid translations), for
    /// multigrid
    Preconditioner(const Matrix        &A,
                   const Matrix        &B,
                   const Matrix        &S,
                   bool                 multigrid,
                   std::vector<double> &near_kernel);

    void vmult(BlockVector &z, const BlockVector &r) const;

  private:
    const Matrix                                               &B_;
    std::unique_ptr<dealii::TrilinosWrappers::PreconditionBase> A_;
    dealii::TrilinosWrappers::PreconditionILU                   S_;
    mutable Vector                                              momentum_;
  };
} // namespace retroforge
