// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/rank_groups.h>

#include <exception>

namespace retroforge
{
  RankGroups::RankGroups(MPI_Comm all, const unsigned int n, const std::string &where)
      : all_(all), n_(n), group_(all)
  {
    const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(all);
    if (n == 0 || n_ranks % n != 0)
      throw Error(where,
                  "is " + std::to_string(n) + ", and there are " + std::to_string(n_ranks) + " ranks",
                  "all groups have the same number of ranks, one at least",
                  "start it by mpirun -np " + std::to_string(n) + ", or a multiple of that");
    if (n == 1)
      return;
    const unsigned int size = n_ranks / n, rank = dealii::Utilities::MPI::this_mpi_process(all);
    number_ = rank / size;
    MPI_Comm_split(all, static_cast<int>(number_), static_cast<int>(rank), &group_);
    MPI_Comm_split(all, static_cast<int>(rank % size), static_cast<int>(rank), &across_);
  }

  RankGroups::~RankGroups()
  {
    // To free them is collective, and other groups may know nothing of an exception.
    if (n_ == 1 || std::uncaught_exceptions() > 0)
      return;
    MPI_Comm_free(&across_);
    MPI_Comm_free(&group_);
  }
} // namespace retroforge
