// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/ownership.h>
#include <retroforge/mesh/topology.h>

namespace retroforge
{
  /// Who works on what. The graph of nodes that share a cell is cut by METIS into parts of equal size with
  /// few edges between them; a cell goes with its smallest node. A rank visits every cell that touches one of
  /// its nodes and keeps what falls on its own nodes, so that sums are formed in the same order on any number
  /// of ranks.
  class Partition
  {
  public:
    Partition(const TetMesh &mesh, const Topology &topology, MPI_Comm comm);

    const Ownership &nodes() const { return nodes_; }
    const Ownership &cells() const { return cells_; }
    /// Rank of each node of the mesh.
    const std::vector<unsigned int> &owner_of_nodes() const { return owner_; }

    bool owns(const NodeIndex node) const { return nodes_.owns(node); }
    /// Whether one of the nodes is owned.
    bool sees(const std::array<NodeIndex, 2> &nodes) const { return owns(nodes[0]) || owns(nodes[1]); }

    /// Sum over ranks of one number per rank.
    double sum(double x) const;

    MPI_Comm               comm;
    std::vector<CellIndex> visited_cells; ///< touching an owned node, ascending

  private:
    std::vector<unsigned int> owner_; ///< of each node; the rest follows from it
    Ownership                 nodes_, cells_;
  };
} // namespace retroforge
