// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/element/mini_element.h>
#include <retroforge/element/point_rates.h>

#include <cmath>

/// @file
/// Measures of the stress of a cell, of its deviator s [MPa].
namespace retroforge
{
  using SymmetricTensor = Symmetric<double>;

  /// Equivalent stress sqrt(3/2 s:s) [MPa]; of none zero with zero derivative, where sqrt alone would give 0/0.
  template <typename Number>
  Number von_mises(const Symmetric<Number> &s)
  {
    using std::sqrt;
    const Number square = 1.5 * double_contraction(s, s);
    return value_of(square) > 0. ? Number(sqrt(square)) : Number(0.);
  }

  template <typename Number>
  Number determinant(const Symmetric<Number> &s)
  {
    return s[0] * (s[1] * s[2] - s[3] * s[3]) - s[5] * (s[5] * s[2] - s[3] * s[4]) +
           s[4] * (s[5] * s[3] - s[1] * s[4]);
  }

  /// Part of 1 by which the cosine of Lode's angle is made smaller.
  inline constexpr double rounded_corner = 1e-4;

  /// Largest principal value of a deviator [MPa], by Lode's angle:
  ///   2 sqrt(J_2/3) cos(1/3 arccos((1 - r) x)),   x = 3 sqrt(3)/2 J_3/J_2^(3/2),  J_2 = 1/2 s:s,  J_3 = det s.
  /// With r = 0 it is that value, which has no derivative where the two largest ones coincide, as in every
  /// upsetting. With r, rounded_corner, it is smooth in s: larger by 0.27 % of the equivalent stress there,
  /// by less elsewhere (1e-5 where the two others coincide, as in tension).
  template <typename Number>
  Number largest_principal(const Symmetric<Number> &s)
  {
    using std::acos;
    using std::cos;
    using std::sqrt;
    const Number J2 = 0.5 * double_contraction(s, s);
    if (value_of(J2) == 0.)
      return Number(0.);
    const Number root = sqrt(J2);
    const Number x    = 1.5 * std::sqrt(3.) * determinant(s) / (J2 * root);
    return 2. / std::sqrt(3.) * root * cos(Number(acos(Number((1. - rounded_corner) * x)) / 3.));
  }
} // namespace retroforge
