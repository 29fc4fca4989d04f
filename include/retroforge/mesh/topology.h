// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/rows.h>
#include <retroforge/mesh/tet_mesh.h>

#include <array>

namespace retroforge
{
  /// The adjacency of nodes, edges, faces and cells: lists that depend on connectivity and patches only, not
  /// on positions.
  struct Topology
  {
    /// Indices into TetMesh::faces of the surface faces (those not on a symmetry plane) at each node,
    /// ascending.
    Rows<unsigned int> surface_faces;
    /// The edges of these faces, each once, the smaller node first, ascending.
    std::vector<std::array<NodeIndex, 2>> surface_edges;
    /// The number of images of each of these edges at its first and at its second node, in the whole that the
    /// planes of symmetry cut: once away from planes, twice where the node lies on a plane and the edge does
    /// not.
    std::vector<std::array<unsigned int, 2>> edge_images;
    /// Cells at each node, ascending.
    Rows<CellIndex> cells;
    /// The cell of each face of the mesh; invalid_index of one that belongs to none.
    std::vector<CellIndex> cell_of_face;
    /// Nodes that share a cell with each node, itself included, ascending.
    Rows<NodeIndex> neighbours;
    /// Orthonormal directions in which the symmetry planes hold each node: none, one on a plane, two on the
    /// edge of two planes, three in a corner. The first is the outward normal of the first plane in the order
    /// of the patches.
    Rows<Vec3> fixed_directions;

    explicit Topology(const TetMesh &mesh);

    bool is_on_surface(const NodeIndex node) const { return surface_faces[node].size() > 0; }
  };
} // namespace retroforge
