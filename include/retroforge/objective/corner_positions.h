// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/clipped_volume.h>
#include <retroforge/geometry/triangle_surface.h>

namespace retroforge
{
  /// Returns the corners of a triangle.
  template <typename Number>
  std::array<Vector3<Number>, 3> corners_of(const NodalVectors<Number> &x, const Triangle &triangle)
  {
    return {{x[triangle[0]], x[triangle[1]], x[triangle[2]]}};
  }

  /// Returns a triangle moved by a shift.
  template <typename Number>
  std::array<Vector3<Number>, 3> shifted(std::array<Vector3<Number>, 3> x, const Vector3<Number> &shift)
  {
    for (auto &corner : x)
      corner += shift;
    return x;
  }

  /// Middles of the edges of a triangle.
  template <typename Number>
  std::array<Vector3<Number>, 3> middles(const std::array<Vector3<Number>, 3> &x)
  {
    return {{(x[0] + x[1]) * Number(0.5), (x[1] + x[2]) * Number(0.5), (x[2] + x[0]) * Number(0.5)}};
  }

  /// Returns whether all points are in all half-spaces.
  template <std::size_t n>
  bool all_inside(const std::array<Vec3, n> &x, const std::vector<HalfSpace<double>> &half_spaces)
  {
    for (const auto &space : half_spaces)
      for (const Vec3 &point : x)
        if (space.excess(point) > 0.)
          return false;
    return true;
  }

  /// Returns points without their derivatives.
  template <typename Number, std::size_t n>
  std::array<Vec3, n> values_of(const std::array<Vector3<Number>, n> &x)
  {
    std::array<Vec3, n> values;
    for (std::size_t k = 0; k < n; ++k)
      for (unsigned int i = 0; i < 3; ++i)
        values[k][i] = value_of(x[k][i]);
    return values;
  }
} // namespace retroforge
