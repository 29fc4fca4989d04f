// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/remeshing/remeshing_context.h>

namespace retroforge
{
  /// Puts a new node on the edge a-b, at the middle or, if `optimised`, where the smallest quality of the new
  /// cells is greatest; on the boundary it lies on the old region or curve. Refused unless every new cell is
  /// better than `bound` and new boundary faces look the same way as the ones they halve. A node at the
  /// middle that nodes behind it keep from its place goes as far towards it as they let it; fit_pass() does
  /// the rest.
  std::optional<CavityChange>
  plan_split(const RemeshingContext &context, NodeIndex a, NodeIndex b, double bound, bool optimised);
} // namespace retroforge
