// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/mpi.h>

#include <retroforge/core/replicated_entries.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    /// The first number of each rank, and the end, when each has so many.
    std::vector<unsigned int> ranges_of_ranks(const unsigned int n_owned, const MPI_Comm comm)
    {
      std::vector<unsigned int> begin(1, 0);
      for (const unsigned int n : dealii::Utilities::MPI::all_gather(comm, n_owned))
        begin.push_back(begin.back() + n);
      return begin;
    }

    /// Lists of all ranks, one after the other. @param begin  of each rank's list, and the end
    std::vector<unsigned int>
    joined(const std::vector<unsigned int> &own, const std::vector<unsigned int> &begin, const MPI_Comm comm)
    {
      std::vector<int> counts, offsets;
      for (std::size_t r = 0; r + 1 < begin.size(); ++r)
      {
        counts.push_back(begin[r + 1] - begin[r]);
        offsets.push_back(begin[r]);
      }
      std::vector<unsigned int> all(begin.back());
      MPI_Allgatherv(
        own.data(), own.size(), MPI_UNSIGNED, all.data(), counts.data(), offsets.data(), MPI_UNSIGNED, comm);
      return all;
    }
  } // namespace

  ReplicatedEntries::ReplicatedEntries(const std::vector<unsigned int> &owned,
                                       const unsigned int               n,
                                       const MPI_Comm                   comm)
      : owned_(owned), begin_(ranges_of_ranks(owned.size(), comm)), comm_(comm)
  {
    AssertThrow(begin_.back() == n, dealii::ExcDimensionMismatch(begin_.back(), n));
    Assert(std::is_sorted(owned.begin(), owned.end()), dealii::ExcInternalError());
    order_                  = joined(owned, begin_, comm);
    const unsigned int mine = dealii::Utilities::MPI::this_mpi_process(comm);
    range_                  = {begin_[mine], begin_[mine + 1], n};
  }

  bool ReplicatedEntries::owns(const unsigned int entry) const
  {
    return owned_.size() == order_.size() ? entry < order_.size()
                                          : std::binary_search(owned_.begin(), owned_.end(), entry);
  }

  void ReplicatedEntries::complete(double *values, const unsigned int width) const
  {
    const unsigned int n_ranks = begin_.size() - 1;
    if (n_ranks == 1)
      return;
    std::vector<int> counts(n_ranks), offsets(n_ranks);
    for (unsigned int r = 0; r < n_ranks; ++r)
    {
      counts[r]  = width * (begin_[r + 1] - begin_[r]);
      offsets[r] = width * begin_[r];
    }
    std::vector<double> in_order(width * order_.size());
    double             *own = in_order.data() + width * range_.begin;
    for (const unsigned int entry : owned_)
      own = std::copy_n(values + width * entry, width, own);
    MPI_Allgatherv(
      MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, in_order.data(), counts.data(), offsets.data(), MPI_DOUBLE, comm_);
    for (std::size_t i = 0; i < order_.size(); ++i)
      std::copy_n(&in_order[width * i], width, values + width * order_[i]);
  }
} // namespace retroforge
