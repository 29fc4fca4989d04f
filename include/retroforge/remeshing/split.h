// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/remeshing/remeshing_context.h>

namespace retroforge
{
  /// The position of the new node of a split edge.
  enum class SplitAt
  {
    middle,  ///< on the boundary: the place of the middle on the old region or curve
    towards, ///< the same, or as far on the way there as the nodes behind let it; fit_pass() does the rest
    best     ///< the position at which the smallest quality of the new cells is greatest
  };

  /// Puts a new node on the edge a-b. Refused unless every new cell is better than `bound` and new boundary
  /// faces look the same way as the ones they halve.
  std::optional<CavityChange>
  plan_split(const RemeshingContext &context, NodeIndex a, NodeIndex b, double bound, SplitAt at);
} // namespace retroforge
