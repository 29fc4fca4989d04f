// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/partitioner.h>

#include <retroforge/core/node_range.h>

#include <functional>
#include <memory>
#include <vector>

namespace retroforge
{
  /// Whose the entries of an array are, one for each node or cell. In matrices they have other numbers: those
  /// of a rank follow each other, in their order.
  class Ownership
  {
  public:
    /// @param owner  rank of each entry, the same on all ranks
    Ownership(const std::vector<unsigned int> &owner, MPI_Comm comm);

    /// This rank's numbers in matrices.
    const NodeRange &range() const { return range_; }
    /// This rank's entries, ascending.
    const std::vector<unsigned int> &owned() const { return owned_; }
    /// Any entry's number in matrices.
    unsigned int number(const unsigned int entry) const { return number_[entry]; }
    /// Where an owned entry stands among the owned ones.
    unsigned int local(const unsigned int entry) const { return number_[entry] - range_.begin; }
    /// An invalid_index is nobody's.
    bool owns(const unsigned int entry) const
    {
      return entry < number_.size() && range_.owns(number_[entry]);
    }

    /// Completes an array of `width` doubles per entry whose owned entries are right. Collective.
    void gather(double *values, unsigned int width) const;

    MPI_Comm comm() const { return comm_; }

  private:
    std::vector<unsigned int> owned_, number_;
    NodeRange                 range_;
    std::vector<unsigned int> begin_; ///< first number of each rank, and the end
    MPI_Comm                  comm_;
  };

  /// Brings entries of other ranks that this rank reads up to date: what a neighbour needs is sent, not all.
  class GhostExchange
  {
  public:
    using Place = std::function<unsigned int(unsigned int)>;

    /// @param ghosts  entries that this rank reads; owned ones and repetitions are left out
    /// @param width   doubles per entry
    /// @param place   where an entry that is owned or read stands in arrays; null: they have all entries
    GhostExchange(const Ownership                 &ownership,
                  const std::vector<unsigned int> &ghosts,
                  unsigned int                     width,
                  const Place                     &place = {});

    /// Only entries of other ranks that this one reads change. Collective.
    void update(double *values) const;

    /// The transpose of update but for the sum: adds what others have at their ghosts to owned entries, in
    /// the order of ranks. Collective.
    void collect(double *values) const;

    /// How many entries of other ranks this one reads.
    unsigned int size() const { return ghosts_.size(); }

  private:
    std::vector<unsigned int>           owned_, ghosts_; ///< their places, in the order of numbers
    unsigned int                        width_;
    dealii::Utilities::MPI::Partitioner partitioner_;
  };
} // namespace retroforge
