// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/remeshing/placement.h>
#include <retroforge/remeshing/surface_features.h>

#include <array>
#include <vector>

namespace retroforge
{
  using Cell = std::array<NodeIndex, 4>;

  struct SurfaceFace
  {
    std::array<NodeIndex, 3> nodes; ///< counter-clockwise seen from outside
    unsigned int             region;
  };

  struct Ridge
  {
    std::array<NodeIndex, 2> nodes;
    unsigned int             curve;
  };

  /// The effect of one operation: cells, boundary faces and ridges that are removed and added, and at most
  /// one node that is new (its index is the number of nodes) or moves. Qualities are the smallest of the
  /// removed cells and of the added ones (1 when there are none). An operation computes and checks it;
  /// applying it is then safe.
  struct CavityChange
  {
    std::vector<CellIndex>    removed_cells;
    std::vector<Cell>         added_cells;
    std::vector<unsigned int> removed_faces;
    std::vector<SurfaceFace>  added_faces;
    std::vector<Ridge>        removed_ridges;
    std::vector<Ridge>        added_ridges;
    NodeIndex                 placed_node = invalid_index;
    Vec3                      position;
    Placement                 placement; ///< how the position was found
    double                    quality_before = 1;
    double                    quality_after  = 1;

    double gain() const { return quality_after - quality_before; }
  };

  /// A tetrahedral mesh whose connectivity can change. Cells and faces get a new index whenever they change,
  /// and old indices are not used again, so that an index tells how old something is.
  class EditableMesh
  {
  public:
    EditableMesh(const TetMesh &mesh, const NodalVectors<double> &X, const SurfaceFeatures &features);

    unsigned int n_nodes() const { return X_.size(); }
    CellIndex    n_cells() const { return cells_.size(); } ///< all there ever were
    unsigned int n_faces() const { return faces_.size(); } ///< all there ever were
    bool         is_alive(const CellIndex cell) const { return cells_[cell][0] != invalid_index; }
    bool is_face_alive(const unsigned int face) const { return faces_[face].nodes[0] != invalid_index; }
    bool is_used(const NodeIndex node) const { return !cells_at_[node].empty(); }
    /// Nodes of the input that were moved, and all new ones.
    bool is_moved(const NodeIndex node) const { return is_moved_[node]; }

    const Vec3        &X(const NodeIndex node) const { return X_[node]; }
    const Cell        &cell(const CellIndex cell) const { return cells_[cell]; }
    double             quality(const CellIndex cell) const { return quality_[cell]; }
    const SurfaceFace &face(const unsigned int face) const { return faces_[face]; }
    /// The first cell index given out after the star of the node changed last.
    CellIndex last_change(const NodeIndex node) const { return last_change_[node]; }

    const std::vector<CellIndex>    &cells_at(const NodeIndex node) const { return cells_at_[node]; }
    const std::vector<unsigned int> &faces_at(const NodeIndex node) const { return faces_at_[node]; }
    const std::vector<Ridge>        &ridges_at(const NodeIndex node) const { return ridges_at_[node]; }

    NodeKind                  kind(NodeIndex node) const;
    std::vector<CellIndex>    cells_at_edge(NodeIndex a, NodeIndex b) const;
    std::vector<unsigned int> faces_at_edge(NodeIndex a, NodeIndex b) const;
    bool                      is_edge(NodeIndex a, NodeIndex b) const;
    /// The curve of a ridge edge; invalid_index when the edge is none.
    unsigned int curve_of_edge(NodeIndex a, NodeIndex b) const;
    /// All nodes that share a cell with the node, ascending, without itself.
    std::vector<NodeIndex> neighbours(NodeIndex node) const;

    void apply(const CavityChange &change);

  private:
    void add_cell(const Cell &cell);
    void remove_cell(CellIndex cell);
    void add_face(const SurfaceFace &face);
    void remove_face(unsigned int face);
    void add_ridge(const Ridge &ridge);
    void remove_ridge(const Ridge &ridge);

    NodalVectors<double>                   X_;
    std::vector<Cell>                      cells_;
    std::vector<double>                    quality_;
    std::vector<SurfaceFace>               faces_;
    std::vector<std::vector<CellIndex>>    cells_at_;
    std::vector<std::vector<unsigned int>> faces_at_;
    std::vector<std::vector<Ridge>>        ridges_at_;
    std::vector<bool>                      is_corner_;
    std::vector<bool>                      is_moved_;
    std::vector<CellIndex>                 last_change_;
  };

  /// The mesh without what was removed (no names of patches: the editable mesh has none). Nodes that were not
  /// moved come first, in their old order; `old_node` names them, and is invalid_index for the others.
  TetMesh
  compacted(const EditableMesh &edited, const SurfaceFeatures &features, std::vector<NodeIndex> &old_node);

  /// Returns the nodes of the edited mesh in the order in which compacted() numbers them.
  std::vector<NodeIndex> order_of_compacted(const EditableMesh &edited);

  /// Returns whether a list of nodes contains a node.
  template <std::size_t n>
  bool contains(const std::array<NodeIndex, n> &nodes, const NodeIndex node)
  {
    for (const NodeIndex other : nodes)
      if (other == node)
        return true;
    return false;
  }

  /// The list with one node exchanged for another.
  template <std::size_t n>
  std::array<NodeIndex, n> replaced(std::array<NodeIndex, n> nodes, const NodeIndex from, const NodeIndex to)
  {
    for (NodeIndex &node : nodes)
      if (node == from)
        node = to;
    return nodes;
  }
} // namespace retroforge
