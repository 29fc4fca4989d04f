// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/triangle_surface.h>

namespace retroforge
{
  /// Curvature at each facet [1/mm]: over its three edges the largest of the angle between the normals on
  /// both sides over the distance of the two centroids, measured across the edge. It is 1/R on a finely
  /// triangulated cylinder of radius R, and grows with refinement at a sharp edge.
  std::vector<double> facet_curvature(const TriangleSurface &surface);
} // namespace retroforge
