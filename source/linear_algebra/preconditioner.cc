// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/linear_algebra/preconditioner.h>

#include <Teuchos_ParameterList.hpp>
#include <ml_MultiLevelPreconditioner.h>

namespace retroforge
{
  namespace
  {
    using namespace dealii::TrilinosWrappers;

    /// Smoothed aggregation with Chebyshev smoothing and a direct coarse solve.
    Teuchos::ParameterList multigrid_parameters(const std::vector<double> &near_kernel)
    {
      Teuchos::ParameterList list;
      ML_Epetra::SetDefaults("SA", list);
      list.set("ML output", 0);
      list.set("PDE equations", 3);
      list.set("aggregation: type", "Uncoupled");
      list.set("aggregation: threshold", 0.01);
      list.set("smoother: type", "Chebyshev");
      list.set("smoother: sweeps", 2);
      list.set("smoother: pre or post", "both");
      list.set("coarse: type", "Amesos-KLU");
      list.set("coarse: max size", 400);
      list.set("null space: type", "pre-computed");
      list.set("null space: dimension", 3);
      list.set("null space: vectors", const_cast<double *>(near_kernel.data()));
      return list;
    }
  } // namespace

  Preconditioner::Preconditioner(const la::SparseMatrix    &A,
                                 const la::SparseMatrix    &B,
                                 const la::SparseMatrix    &D,
                                 const la::SparseMatrix    &S,
                                 const bool                 multigrid,
                                 const std::vector<double> &near_kernel)
      : B_(B), D_(D), momentum_(A.locally_owned_range_indices(), A.get_mpi_communicator())
  {
    if (multigrid)
    {
      auto amg = std::make_unique<PreconditionAMG>();
      amg->initialize(A, multigrid_parameters(near_kernel));
      A_ = std::move(amg);
    }
    else
    {
      auto ilu = std::make_unique<PreconditionILU>();
      ilu->initialize(A);
      A_ = std::move(ilu);
    }
    S_.initialize(S);
  }

  void Preconditioner::vmult(la::BlockVector &z, const la::BlockVector &r) const
  {
    S_.vmult(z.block(1), r.block(1));
    z.block(1) *= -1.;
    B_.vmult(momentum_, z.block(1));
    momentum_.sadd(-1., 1., r.block(0));
    A_->vmult(z.block(0), momentum_);
  }

  void Preconditioner::Tvmult(la::BlockVector &z, const la::BlockVector &r) const
  {
    S_.vmult(z.block(1), r.block(1));
    z.block(1) *= -1.;
    D_.Tvmult(momentum_, z.block(1));
    momentum_.sadd(-1., 1., r.block(0));
    A_->vmult(z.block(0), momentum_);
  }
} // namespace retroforge
