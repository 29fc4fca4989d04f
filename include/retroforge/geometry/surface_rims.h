// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/triangle_surface.h>

#include <vector>

namespace retroforge
{
  /// A closed line of edges that belong to one facet only.
  struct SurfaceRim
  {
    unsigned int n_edges = 0;
    double       length  = 0.; ///< [mm]
    Vec3         centre;       ///< mean of its vertices [mm]
  };

  /// The rims of a surface, the longest first. An open die has one, its outer one; others bound holes. Holes
  /// that touch at a vertex have one rim.
  std::vector<SurfaceRim> find_rims(const TriangleSurface &surface);
} // namespace retroforge
