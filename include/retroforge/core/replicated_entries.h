// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/node_range.h>

#include <vector>

#include <mpi.h>

namespace retroforge
{
  /// Arrays with an entry for each node or cell that every rank keeps, and each rank knows in part.
  class ReplicatedEntries
  {
  public:
    ReplicatedEntries() = default;

    /// @param owned  entries that this rank knows, ascending; each of 0 … n - 1 is one rank's. Collective.
    ReplicatedEntries(const std::vector<unsigned int> &owned, unsigned int n, MPI_Comm comm);

    /// Entries of this rank, ascending.
    const std::vector<unsigned int> &owned() const { return owned_; }
    bool                             owns(unsigned int entry) const;

    /// Entries of all ranks, one rank after the other.
    const std::vector<unsigned int> &in_order_of_ranks() const { return order_; }
    /// Returns the range of this rank's entries in that order.
    const NodeRange &range() const { return range_; }

    /// Makes an array of `width` doubles per entry complete whose owned entries are right. Collective.
    void complete(double *values, unsigned int width) const;

    MPI_Comm comm() const { return comm_; }

  private:
    std::vector<unsigned int> owned_, order_;
    NodeRange                 range_;
    std::vector<unsigned int> begin_; ///< first entry of each rank in the order, and the end
    MPI_Comm                  comm_ = MPI_COMM_SELF;
  };
} // namespace retroforge
