// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/billet/spline_curve.h>

#include <string>
#include <vector>

namespace retroforge
{
  /// A piece of the contour of a meridian section; `patch` is the name of the surface it makes when it is
  /// revolved, none on the axis.
  struct Portion
  {
    std::string patch;
    SplineCurve curve;
  };

  /// Meridian section of a body of revolution: portions of its contour, clockwise seen with r to the right
  /// and z upwards, each beginning where the one before ends, the last ending where the first begins.
  using Section = std::vector<Portion>;

  SplineCurve segment(const Vec2 &from, const Vec2 &to);

  /// Volume of the body of revolution  V = -pi sum_portions int r^2 dz,  by ten Gauss points in each span:
  /// exact for polynomial portions.
  double volume_of_revolution(const Section &section);
} // namespace retroforge
