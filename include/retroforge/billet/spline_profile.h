// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/parameter_handler.h>

#include <retroforge/billet/section.h>

namespace retroforge
{
  /// Meridian section between an inner line r = inner_radius (the axis, if zero) and an outer contour that is
  /// a clamped cubic B-spline from the bottom to the top, closed by level lines from the ends of the contour
  /// to the inner line; z counts from the base centre.
  ///
  /// Each point of the section lies on a ray from the inner line to the contour,
  ///   x = (1-s) a(t) + s c(t),   a(t) = (inner_radius, (1-t) z_first + t z_last),   0 <= s, t <= 1,
  /// and a sound contour is one that each ray meets once, from inside.
  struct SplineProfile
  {
    std::vector<Vec2> control_points; ///< (r, z) of the contour, from bottom to top
    double            inner_radius = 0;

    void add_parameters(dealii::ParameterHandler &prm);

    /// Returns the rule that the contour breaks with these control points, in words; empty when none.
    std::string complaint(const std::vector<Vec2> &control_points) const;

    SplineCurve contour() const { return {control_points, 3}; }
    Section     section() const;
    double      height() const { return control_points.back()[1] - control_points.front()[1]; }
    double      width() const; ///< twice the largest radius of a control point

    /// The coordinates of a point of the section.
    struct RayPoint
    {
      double t; ///< along the contour
      double s; ///< 0 on the inner line, 1 on the contour
    };
    RayPoint locate(const Vec2 &x) const;

    /// Point number i of the contour lies on the inner line, as the end of a closed contour does.
    bool is_on_inner_line(unsigned int i) const { return control_points[i][0] == inner_radius; }

  private:
    Vec2 start_of_ray(double t) const;
  };
} // namespace retroforge
