// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/cell_faces.h>

#include <algorithm>
#include <tuple>

namespace retroforge
{
  FaceKey face_key(const std::array<NodeIndex, 3> &nodes)
  {
    FaceKey key = nodes;
    std::sort(key.begin(), key.end());
    return key;
  }

  std::vector<CellFace> sorted_cell_faces(const std::vector<std::array<NodeIndex, 4>> &cells)
  {
    std::vector<CellFace> faces;
    faces.reserve(4 * cells.size());
    for (CellIndex c = 0; c < cells.size(); ++c)
      for (const auto &corner : tet_face_corners)
      {
        const std::array<NodeIndex, 3> nodes = {
          {cells[c][corner[0]], cells[c][corner[1]], cells[c][corner[2]]}};
        faces.push_back({face_key(nodes), nodes, c});
      }
    std::sort(faces.begin(), faces.end(), [](const CellFace &a, const CellFace &b) {
      return std::tie(a.key, a.cell) < std::tie(b.key, b.cell);
    });
    return faces;
  }

  std::vector<CellFace> boundary_cell_faces(const std::vector<std::array<NodeIndex, 4>> &cells)
  {
    const auto            all = sorted_cell_faces(cells);
    std::vector<CellFace> boundary;
    for (std::size_t i = 0; i < all.size(); ++i)
    {
      const bool shared_before = i > 0 && all[i - 1].key == all[i].key;
      const bool shared_after  = i + 1 < all.size() && all[i + 1].key == all[i].key;
      if (!shared_before && !shared_after)
        boundary.push_back(all[i]);
    }
    return boundary;
  }
} // namespace retroforge
