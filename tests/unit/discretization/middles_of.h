// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/discretization/middle_nodes.h>
#include <retroforge/element/cell_geometry.h>
#include <retroforge/mesh/tet_mesh.h>

namespace retroforge
{
  /// The middles of a mesh's edges, from its cells alone.
  inline MiddleNodes middles_of(const TetMesh &mesh)
  {
    std::vector<MiddleNodes::Ends> ends;
    for (const auto &cell : mesh.cells)
      for (const auto &[a, b] : tet_edge_corners)
        ends.push_back({{std::min(cell[a], cell[b]), std::max(cell[a], cell[b])}});
    return MiddleNodes(mesh.n_nodes(), std::move(ends));
  }
} // namespace retroforge
