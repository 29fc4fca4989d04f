// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/remeshing/remeshing_context.h>

namespace retroforge
{
  /// Merges node `a` into its neighbour `b`, which stays where it is. Refused, unless
  /// - the edge a-b carries every feature of a: an interior node may go anywhere, a node of a region along
  ///   boundary edges inside that region, a node of a ridge along its curve, a corner nowhere;
  /// - the links of a and b meet in the link of the edge only, counting the outside as one more node (Dey and
  ///   others 1999): so no parts of the mesh or of its boundary are merged;
  /// - every changed cell is better than `bound` and no new edge is longer than `longest` times the wanted
  ///   length;
  /// - every changed boundary face faces the same way as before, and stays within the deviation that the
  ///   parameters allow of the position of a.
  std::optional<CavityChange>
  plan_collapse(const RemeshingContext &context, NodeIndex a, NodeIndex b, double bound, double longest);
} // namespace retroforge
