// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/mpi.h>

#include <string>
#include <vector>

namespace retroforge
{
  /// The ranks of a program in groups of equal size, one after the other, that work side by side.
  class RankGroups
  {
  public:
    /// Collective.
    /// @param where  the number is asked for, for the message
    /// @throws Error  where the ranks cannot be shared out evenly
    RankGroups(MPI_Comm all, unsigned int n, const std::string &where);
    ~RankGroups();
    RankGroups(const RankGroups &) = delete;

    unsigned int n() const { return n_; }
    unsigned int number() const { return number_; } ///< of this rank's group
    MPI_Comm     comm() const { return group_; }    ///< of this rank's group
    MPI_Comm     all() const { return all_; }
    bool         is_first_rank() const { return dealii::Utilities::MPI::this_mpi_process(all_) == 0; }

    /// Gathers a value of each group, in their order, on all ranks. Collective.
    /// @param mine  the same on all ranks of a group
    template <typename T>
    std::vector<T> gathered(const T &mine) const
    {
      return n_ == 1 ? std::vector<T>{mine} : dealii::Utilities::MPI::all_gather(across_, mine);
    }

  private:
    const MPI_Comm     all_;
    const unsigned int n_;
    unsigned int       number_ = 0;
    MPI_Comm           group_;
    MPI_Comm           across_ = MPI_COMM_NULL; ///< ranks of the same place in their groups
  };
} // namespace retroforge
