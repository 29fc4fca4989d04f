// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/types.h>

#include <algorithm>
#include <array>
#include <vector>

namespace retroforge
{
  /// Corners of the four faces of a tetrahedron, face a opposite corner a, counter-clockwise seen from
  /// outside.
  inline constexpr unsigned int tet_face_corners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

  /// Three nodes in ascending order: what two cells that share a face agree on.
  using FaceKey = std::array<NodeIndex, 3>;
  FaceKey face_key(const std::array<NodeIndex, 3> &nodes);

  /// Two nodes in ascending order: what cells that share an edge agree on.
  using EdgeKey = std::array<NodeIndex, 2>;
  inline EdgeKey edge_key(const NodeIndex a, const NodeIndex b)
  {
    return {{std::min(a, b), std::max(a, b)}};
  }

  /// One face of one cell, turned outwards.
  struct CellFace
  {
    FaceKey                  key;
    std::array<NodeIndex, 3> nodes;
    CellIndex                cell;
  };

  /// The faces of all cells, sorted by key and then by cell, so that shared faces stand side by side.
  std::vector<CellFace> sorted_cell_faces(const std::vector<std::array<NodeIndex, 4>> &cells);

  /// The faces that belong to one cell only: the boundary, in the order of their keys.
  std::vector<CellFace> boundary_cell_faces(const std::vector<std::array<NodeIndex, 4>> &cells);
} // namespace retroforge
