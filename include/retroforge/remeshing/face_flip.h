// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/remeshing/remeshing_context.h>

namespace retroforge
{
  /// Removes the face opposite corner `corner` of a cell: the two cells that share it become three around the
  /// edge that joins their apices, when that raises the smallest quality of the two by more than
  /// `least_gain`. Faces of the boundary stay.
  std::optional<CavityChange>
  plan_face_flip(const RemeshingContext &context, CellIndex cell, unsigned int corner, double least_gain);
} // namespace retroforge
