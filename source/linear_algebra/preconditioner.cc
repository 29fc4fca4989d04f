// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/linear_algebra/p_multigrid.h>
#include <retroforge/linear_algebra/preconditioner.h>

namespace retroforge
{
  Preconditioner::Preconditioner(const BlockedMatrix       &A,
                                 const BlockedMatrix       &B,
                                 const la::SparseMatrix    &D,
                                 const la::SparseMatrix    &S,
                                 const bool                 multigrid,
                                 const std::vector<double> &near_kernel,
                                 const la::SparseMatrix    *interpolation)
      : B_(B), D_(D), momentum_(A.matrix().locally_owned_range_indices(), A.matrix().get_mpi_communicator())
  {
    if (multigrid && interpolation)
      A_ = std::make_unique<PMultigrid>(A.matrix(), *interpolation, near_kernel);
    else if (multigrid)
      A_ = make_algebraic_multigrid(A, near_kernel);
    else
    {
      auto ilu = std::make_unique<dealii::TrilinosWrappers::PreconditionILU>();
      ilu->initialize(A.matrix());
      A_ = std::move(ilu);
    }
    S_.initialize(S);
  }

  void Preconditioner::vmult(la::BlockVector &z, const la::BlockVector &r) const
  {
    S_.vmult(z.block(1), r.block(1));
    B_.vmult(momentum_, z.block(1));
    momentum_ += r.block(0);
    z.block(1) *= -1.;
    A_->vmult(z.block(0), momentum_);
  }

  void Preconditioner::Tvmult(la::BlockVector &z, const la::BlockVector &r) const
  {
    S_.vmult(z.block(1), r.block(1));
    D_.Tvmult(momentum_, z.block(1));
    momentum_ += r.block(0);
    z.block(1) *= -1.;
    A_->vmult(z.block(0), momentum_);
  }
} // namespace retroforge
