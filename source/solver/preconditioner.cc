// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/solver/preconditioner.h>

#include <Teuchos_ParameterList.hpp>
#include <ml_MultiLevelPreconditioner.h>

namespace retroforge
{
  namespace
  {
    using namespace dealii::TrilinosWrappers;

    /// Smoothed aggregation with Chebyshev smoothing and a direct coarse solve.
    Teuchos::ParameterList multigrid_parameters(std::vector<double> &near_kernel)
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
      list.set("null space: vectors", near_kernel.data());
      return list;
    }
  } // namespace

  Preconditioner::Preconditioner(const Matrix        &A,
                                 const Matrix        &B,
                                 const Matrix        &S,
                                 const bool           multigrid,
                                 std::vector<double> &near_kernel)
      : B_(B), momentum_(A.locally_owned_range_indices(), A.get_mpi_communicator())
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

  void Preconditioner::vmult(BlockVector &z, const BlockVector &r) const
  {
    S_.vmult(z.block(1), r.block(1));
    z.block(1) *= -1.;
    B_.vmult(momentum_, z.block(1));
    momentum_.sadd(-1., 1., r.block(0));
    A_->vmult(z.block(0), momentum_);
  }
} // namespace retroforge
