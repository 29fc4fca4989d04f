// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/die.h>

namespace retroforge
{
  /// Returns the surface to draw for a die at its displacement; for a plane, the rectangle around the points
  /// X projected onto it, a tenth of its longer side wider all around; its normals point to the workpiece,
  /// too.
  TriangleSurface die_picture(const Die &die, const Vec3 &displacement, const NodalVectors<double> &X);
} // namespace retroforge
