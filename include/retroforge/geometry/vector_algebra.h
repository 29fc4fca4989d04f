// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/types.h>

#include <array>
#include <cmath>

/// @file
/// Products and directions of three vectors' components, for numbers of any type, with their reverse.
namespace retroforge
{
  template <typename Number>
  Vector3<Number> cross(const Vector3<Number> &a, const Vector3<Number> &b)
  {
    Vector3<Number> c;
    for (unsigned int i = 0; i < 3; ++i)
      c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    return c;
  }

  template <typename Number>
  Number length(const Vector3<Number> &a)
  {
    using std::sqrt;
    return sqrt(Number(a * a));
  }

  /// Returns the angle between two vectors, 0 to pi [rad].
  inline double angle_between(const Vec3 &a, const Vec3 &b)
  {
    return std::atan2(cross(a, b).norm(), a * b);
  }

  /// Returns the sum over nodes of a_k·b_k.
  inline double dot(const NodalVectors<double> &a, const NodalVectors<double> &b)
  {
    AssertDimension(a.size(), b.size());
    double sum = 0.;
    for (std::size_t k = 0; k < a.size(); ++k)
      sum += a[k] * b[k];
    return sum;
  }

  /// a / |a|.
  template <typename Number>
  Vector3<Number> unit(const Vector3<Number> &a)
  {
    return a * Number(1. / length(a));
  }

  /// The axis that a vector is least along.
  template <typename Number>
  unsigned int least_axis(const Vector3<Number> &n)
  {
    using std::abs;
    unsigned int axis = 0;
    for (unsigned int i = 1; i < 3; ++i)
      if (abs(n[i]) < abs(n[axis]))
        axis = i;
    return axis;
  }

  /// Two directions across a unit vector n, first of all across the axis that it is least along:  u, n x u.
  template <typename Number>
  std::array<Vector3<Number>, 2> directions_across(const Vector3<Number> &n)
  {
    Vector3<Number> u;
    u[least_axis(n)] = Number(1.);
    u                = cross(n, u);
    u /= length(u);
    return {{u, cross(n, u)}};
  }

  /// Pull-back of unit(a) = u:  a_bar = (u_bar - (u·u_bar) u) / |a|.
  inline Vec3 reverse_unit(const Vec3 &a, const Vec3 &u_bar)
  {
    const double norm = a.norm();
    const Vec3   u    = a / norm;
    return (u_bar - (u * u_bar) * u) / norm;
  }

  /// Pull-back of directions_across(n): returns n_bar.
  inline Vec3 reverse_directions_across(const Vec3 &n, const std::array<Vec3, 2> &bar)
  {
    Vec3 axis;
    axis[least_axis(n)]  = 1.;
    const Vec3 u         = directions_across(n)[0];
    const Vec3 of_across = reverse_unit(cross(n, axis), bar[0] + cross(bar[1], n));
    return cross(u, bar[1]) + cross(axis, of_across);
  }
} // namespace retroforge
