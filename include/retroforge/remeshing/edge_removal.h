// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/remeshing/remeshing_context.h>

namespace retroforge
{
  /// The cells around an edge a-b, and the nodes opposite to it, in the order in which they turn
  /// counter-clockwise seen from b. An edge in the interior has a closed ring, one on the boundary an open
  /// one that begins and ends on the two boundary faces.
  struct EdgeRing
  {
    std::vector<CellIndex> cells;
    std::vector<NodeIndex> nodes;
    bool                   is_closed = false;
  };

  EdgeRing edge_ring(const EditableMesh &mesh, NodeIndex a, NodeIndex b);

  /// Removes the edge a-b: its cells are replaced by those over and under the best triangulation of its
  /// ring, found by dynamic programming (Shewchuk 2002), when that raises the smallest quality of the cavity
  /// by more than `least_gain`. Includes the exchange of three cells for two.
  ///
  /// An edge of the boundary becomes the other diagonal of its two faces, which must lie in one region, look
  /// the same way before and after, and have diagonals that nearly meet; a flat cell under the two faces just
  /// goes. Ridges stay. Rings have up to seven nodes.
  std::optional<CavityChange>
  plan_edge_removal(const RemeshingContext &context, NodeIndex a, NodeIndex b, double least_gain);
} // namespace retroforge
