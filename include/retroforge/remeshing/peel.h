// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/remeshing/remeshing_context.h>

namespace retroforge
{
  /// Takes away the only cell at the boundary edge a-b, so that the edge c-d opposite it comes to the
  /// surface: for a cell that lies within a die, where a-b is a chord of its rounding. Refused unless both
  /// boundary faces are of one region off the symmetry planes and the middle of c-d is less deep in a die
  /// than that of a-b, or where the surface would touch itself. What is lost of the volume is for the volume
  /// correction.
  std::optional<CavityChange> plan_peel(const RemeshingContext &context, NodeIndex a, NodeIndex b);
} // namespace retroforge
