// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/triangle_surface.h>

namespace retroforge
{
  /// Curvature at each facet [1/mm]: over its three edges the largest of the angle between the normals on
  /// both sides over the distance of the two centroids, measured across the edge. It is 1/R on a finely
  /// triangulated cylinder of radius R. Sharp edges, where the surface turns by more than the feature angle,
  /// do not count.
  /// @param feature_angle  [degrees]
  std::vector<double> facet_curvature(const TriangleSurface &surface, double feature_angle);

  /// Sharp edges that stick out of the surface, each once.
  std::vector<TriangleSurface::Edge> sharp_ridges(const TriangleSurface &surface, double feature_angle);

  /// Edges where an open surface ends.
  std::vector<TriangleSurface::Edge> rim(const TriangleSurface &surface);
} // namespace retroforge
