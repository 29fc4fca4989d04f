// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/tet_mesh.h>

namespace retroforge
{
  /// Corners of the six edges of a tetrahedron, in the order of deal.II's lines.
  inline constexpr unsigned int tet_edge_corners[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};

  using EdgeIndex = unsigned int;

  /// The edges of a mesh, numbered. A velocity that is quadratic in each cell has its nodes at the mesh's
  /// nodes, 0 … n_nodes - 1, and in the middle of edge e: node n_nodes + e.
  struct MeshEdges
  {
    /// Each edge once, the smaller node first, ascending.
    std::vector<std::array<NodeIndex, 2>> nodes;
    /// Of each cell, as tet_edge_corners.
    std::vector<std::array<EdgeIndex, 6>> of_cells;
    /// Of each face of the boundary: edge i joins its nodes i and i + 1, the last its nodes 2 and 0.
    std::vector<std::array<EdgeIndex, 3>> of_faces;

    explicit MeshEdges(const TetMesh &mesh);

    unsigned int size() const { return nodes.size(); }

    /// The edge between two nodes, in either order; invalid_index where there is none.
    EdgeIndex find(NodeIndex a, NodeIndex b) const;
  };
} // namespace retroforge
