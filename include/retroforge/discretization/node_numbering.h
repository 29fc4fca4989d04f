// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/partitioner.h>

#include <retroforge/core/replicated_entries.h>
#include <retroforge/core/types.h>

#include <memory>

namespace retroforge
{
  /// The nodes of a space, as its DoFHandler distributes them: `width` degrees of freedom to a node, one
  /// after the other.
  ///
  /// A node has a *number* that is the same on any number of ranks: that of its vertex in the mesh, then the
  /// middles of edges (MiddleNodes), then the bubbles of cells. On a rank it has a *place* in vectors: first
  /// the nodes that the rank owns, in the order of numbers, then those of others that it reads (ghosts).
  /// Among the nodes of all ranks, one rank after the other, it has an *index*: that of its degrees of
  /// freedom, or of its rows in matrices, over the width.
  class NodeNumbering
  {
  public:
    /// @param width  degrees of freedom per node
    /// @param owned  numbers of this rank's nodes, ascending
    /// @param read   numbers of nodes that this rank reads, of whichever rank
    /// @param n      how many nodes there are
    /// Collective.
    NodeNumbering(unsigned int                  width,
                  const std::vector<NodeIndex> &owned,
                  const std::vector<NodeIndex> &read,
                  unsigned int                  n,
                  MPI_Comm                      comm);

    /// Returns the same nodes with another number of entries each.
    std::shared_ptr<const NodeNumbering> of_width(unsigned int width) const;

    /// Returns deal.II's partitioner of the degrees of freedom.
    const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &partitioner() const
    {
      return partitioner_;
    }

    /// Returns the number of nodes on all ranks.
    unsigned int n() const { return nodes_.range().n; }
    /// Returns the number of nodes that a vector has entries for on this rank.
    unsigned int n_places() const { return n_owned() + index_of_ghost_.size(); }
    /// The indices of this rank's nodes, whose places are 0 … n_owned() - 1.
    const NodeRange &range() const { return nodes_.range(); }
    unsigned int     n_owned() const { return range().n_owned(); }

    /// Returns the place of a node in vectors, invalid_index where this rank neither owns nor reads it.
    unsigned int place(const NodeIndex k) const
    {
      AssertIndexRange(k, n());
      return place_.empty() ? k : place_[k];
    }
    /// The number of the node at a place.
    NodeIndex node_at(const unsigned int place) const
    {
      AssertIndexRange(place, n_places());
      return place_.empty() ? place : node_at_[place];
    }
    /// Its index.
    unsigned int index_at(const unsigned int place) const
    {
      AssertIndexRange(place, n_places());
      return place < n_owned() ? range().begin + place : index_of_ghost_[place - n_owned()];
    }
    /// The place of the node with an index.
    unsigned int place_of_index(const unsigned int index) const
    {
      AssertIndexRange(index, n());
      return range().owns(index) ? index - range().begin : place(nodes_.in_order_of_ranks()[index]);
    }

    /// Returns whether a node is this rank's; invalid_index is no rank's.
    bool owns(const NodeIndex k) const { return k != invalid_index && place(k) < n_owned(); }

    /// All nodes, rank by rank.
    const ReplicatedEntries &nodes() const { return nodes_; }
    /// This rank's nodes, ascending.
    const std::vector<NodeIndex> &owned() const { return nodes_.owned(); }

  private:
    void make_partitioner(unsigned int width);

    ReplicatedEntries         nodes_;
    std::vector<unsigned int> place_;          ///< by number; empty: the number itself
    std::vector<NodeIndex>    node_at_;        ///< the same backwards
    std::vector<unsigned int> index_of_ghost_; ///< ascending
    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> partitioner_;
  };
} // namespace retroforge
