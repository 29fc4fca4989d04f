// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/discretization/spaces.h>
#include <retroforge/linear_algebra/node_matrix.h>
#include <retroforge/mesh/partition.h>

namespace retroforge
{
  /// Whose the velocity nodes are: a node of the mesh is that of the partition, the middle of an edge goes
  /// with its smaller node. In matrices the nodes of a rank follow each other, those of the mesh first, and
  /// so have other numbers there.
  class VelocityOwnership
  {
  public:
    VelocityOwnership(const Spaces &spaces, const Partition &partition);

    /// This rank's numbers in matrices.
    const NodeRange &range() const { return range_; }

    unsigned int n_owned() const { return range_.n_owned(); }
    /// Nodes by their number among the owned ones.
    NodeIndex node(const unsigned int local) const
    {
      return local < n_owned_of_mesh() ? local + of_mesh_.begin
                                       : local - n_owned_of_mesh() + of_mesh_.n + of_edges_.begin;
    }
    /// The reverse.
    unsigned int local(const NodeIndex node) const
    {
      return node < of_mesh_.n ? node - of_mesh_.begin
                               : node - of_mesh_.n - of_edges_.begin + n_owned_of_mesh();
    }
    bool owns(const NodeIndex node) const
    {
      return node < of_mesh_.n ? of_mesh_.owns(node) : of_edges_.owns(node - of_mesh_.n);
    }
    /// Any node's number in matrices.
    unsigned int number(NodeIndex node) const;

    /// Completes an array of `width` doubles per node whose owned entries are right. Collective.
    void gather(double *values, unsigned int width) const;
    void gather(NodalVectors<double> &x) const { gather(x.data()->begin_raw(), 3); }

  private:
    unsigned int n_owned_of_mesh() const { return of_mesh_.n_owned(); }

    const Partition          &partition_;
    NodeRange                 of_mesh_, of_edges_, range_;
    std::vector<unsigned int> edge_ranges_; ///< first edge of each rank, and the end
  };
} // namespace retroforge
