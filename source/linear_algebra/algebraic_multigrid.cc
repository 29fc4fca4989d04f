// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/linear_algebra/algebraic_multigrid.h>

#include <Teuchos_ParameterList.hpp>
#include <ml_MultiLevelPreconditioner.h>

namespace retroforge
{
  std::unique_ptr<dealii::TrilinosWrappers::PreconditionAMG>
  make_algebraic_multigrid(const Epetra_RowMatrix &A, const std::vector<double> &near_kernel)
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
    auto multigrid = std::make_unique<dealii::TrilinosWrappers::PreconditionAMG>();
    multigrid->initialize(A, list);
    return multigrid;
  }
} // namespace retroforge
