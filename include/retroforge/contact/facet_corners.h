// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/triangle_surface.h>

namespace retroforge
{
  /// Positions of a triangle's corners [mm].
  using Corners = std::array<Vec3, 3>;

  /// Corners of facet f of a surface that is displaced.
  inline Corners facet_corners(const TriangleSurface &surface, const unsigned int f, const Vec3 &displacement)
  {
    const Triangle &t = surface.triangles()[f];
    const auto     &x = surface.vertices();
    return {{x[t[0]] + displacement, x[t[1]] + displacement, x[t[2]] + displacement}};
  }
} // namespace retroforge
