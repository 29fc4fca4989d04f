// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/edges.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    std::array<NodeIndex, 2> edge_between(const NodeIndex a, const NodeIndex b)
    {
      return {{std::min(a, b), std::max(a, b)}};
    }
  } // namespace

  MeshEdges::MeshEdges(const TetMesh &mesh)
  {
    nodes.reserve(6 * mesh.cells.size());
    for (const auto &cell : mesh.cells)
      for (const auto &edge : tet_edge_corners)
        nodes.push_back(edge_between(cell[edge[0]], cell[edge[1]]));
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    nodes.shrink_to_fit();

    for (const auto &cell : mesh.cells)
    {
      std::array<EdgeIndex, 6> of_cell;
      for (unsigned int e = 0; e < 6; ++e)
        of_cell[e] = find(cell[tet_edge_corners[e][0]], cell[tet_edge_corners[e][1]]);
      of_cells.push_back(of_cell);
    }
    for (const BoundaryFace &face : mesh.faces)
    {
      std::array<EdgeIndex, 3> of_face;
      for (unsigned int i = 0; i < 3; ++i)
        of_face[i] = find(face.nodes[i], face.nodes[(i + 1) % 3]);
      of_faces.push_back(of_face);
    }
  }

  EdgeIndex MeshEdges::find(const NodeIndex a, const NodeIndex b) const
  {
    const auto edge  = edge_between(a, b);
    const auto found = std::lower_bound(nodes.begin(), nodes.end(), edge);
    return found != nodes.end() && *found == edge ? found - nodes.begin() : invalid_index;
  }
} // namespace retroforge
