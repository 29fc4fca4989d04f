// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/element/cell_geometry.h>
#include <retroforge/geometry/vector_algebra.h>

namespace retroforge
{
  template <typename Number>
  CellGeometry<Number> cell_geometry(const Four<Vector3<Number>> &X)
  {
    const Vector3<Number> a = X[1] - X[0], b = X[2] - X[0], c = X[3] - X[0];
    const Vector3<Number> bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
    const Number          det = a * bc;
    CellGeometry<Number>  geometry;
    geometry.volume = det / 6.;
    geometry.g[1]   = bc / det;
    geometry.g[2]   = ca / det;
    geometry.g[3]   = ab / det;
    geometry.g[0]   = -(geometry.g[1] + geometry.g[2] + geometry.g[3]);
    return geometry;
  }
} // namespace retroforge
