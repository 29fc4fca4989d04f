// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/mpi.h>

#include <retroforge/core/shares.h>

#include <cstdint>

namespace retroforge
{
  std::pair<std::size_t, std::size_t> share_of_rank(const std::size_t n, MPI_Comm comm)
  {
    const std::uint64_t ranks = dealii::Utilities::MPI::n_mpi_processes(comm);
    const std::uint64_t rank  = dealii::Utilities::MPI::this_mpi_process(comm);
    return {n * rank / ranks, n * (rank + 1) / ranks};
  }
} // namespace retroforge
