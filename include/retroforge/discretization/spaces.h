// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/topology.h>

#include <memory>

namespace retroforge
{
  /// Pairs of finite elements for velocity and pressure.
  enum class ElementPair
  {
    mini,       ///< P1 and a bubble; P1  (element/mini_element.h)
    taylor_hood ///< P2; P1  (element/taylor_hood.h)
  };

  /// The spaces of velocity and pressure of a pair on a mesh. A velocity has a value at every node of the
  /// mesh, numbered alike, and, where it is quadratic, in the middle of every edge: node n_nodes + edge.
  /// Bubbles belong to cells. Pressures have a value at every node of the mesh.
  class Spaces
  {
  public:
    /// @param visited  cells whose bubbles this rank keeps, ascending; null: all
    Spaces(const TetMesh                &mesh,
           const Topology               &topology,
           ElementPair                   pair,
           const std::vector<CellIndex> *visited = nullptr);

    ElementPair  pair() const { return pair_; }
    unsigned int n_velocity_nodes() const { return n_nodes_ + (edges_ ? edges_->size() : 0); }
    unsigned int n_pressure_nodes() const { return n_nodes_; }
    /// How many this rank keeps.
    unsigned int n_bubbles() const { return n_bubbles_; }
    /// Where the bubble of a cell stands, of those that this rank keeps; of others, invalid_index.
    unsigned int bubble(const CellIndex c) const { return bubble_.empty() ? c : bubble_[c]; }

    unsigned int n_nodes_per_cell() const { return nodes_per_cell_; }
    /// Of a cell: the corners, then the middles of the edges where there are any. The first four are its
    /// pressure nodes.
    const NodeIndex *velocity_nodes(const CellIndex c) const { return &cell_nodes_[nodes_per_cell_ * c]; }

    /// As Topology::fixed_directions, of a velocity node.
    dealii::ArrayView<const Vec3> fixed_directions(const NodeIndex k) const
    {
      return k < n_nodes_ ? fixed_at_nodes_[k] : fixed_at_edges_[k - n_nodes_];
    }

    /// Null where velocities are linear.
    const MeshEdges *edges() const { return edges_.get(); }

  private:
    ElementPair                      pair_;
    unsigned int                     n_nodes_, n_cells_, nodes_per_cell_, n_bubbles_ = 0;
    std::vector<unsigned int>        bubble_; ///< of each cell; empty where all are kept, or none
    std::shared_ptr<const MeshEdges> edges_;
    std::vector<NodeIndex>           cell_nodes_;
    Rows<Vec3>                       fixed_at_nodes_, fixed_at_edges_;
  };
} // namespace retroforge
