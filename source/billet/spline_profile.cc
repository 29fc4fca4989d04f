// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/patterns.h>

#include <retroforge/billet/spline_profile.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace retroforge
{
  void SplineProfile::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter(
      "control points",
      control_points,
      "Control points r, z of the outer contour of a profile, a clamped cubic B-spline from the bottom to "
      "the top, z from the base centre; separated by semicolons, at least four: `20, 0; 26, 15; 26, 30; "
      "20, 45'. The contour begins at the first and ends at the last; from there level lines close it to "
      "the inner radius. Units: mm.");
    prm.add_parameter("inner radius",
                      inner_radius,
                      "Radius of the bore of a profile, 0 for a solid one. Units: mm.",
                      dealii::Patterns::Double(0.));
  }

  double SplineProfile::width() const
  {
    double radius = inner_radius;
    for (const Vec2 &point : control_points)
      radius = std::max(radius, point[0]);
    return 2. * radius;
  }

  Vec2 SplineProfile::start_of_ray(const double t) const
  {
    return Vec2({inner_radius, (1. - t) * control_points.front()[1] + t * control_points.back()[1]});
  }

  std::string SplineProfile::complaint(const std::vector<Vec2> &points) const
  {
    std::ostringstream text;
    if (points.size() < 4)
      return "there are " + std::to_string(points.size()) + " control points, a cubic needs four";
    if (points.size() > 100)
      return "there are " + std::to_string(points.size()) + " control points, there may be 100";
    for (unsigned int i = 0; i < points.size(); ++i)
      if (!(points[i][0] >= inner_radius) || !std::isfinite(points[i].norm()))
      {
        text << "control point " << i + 1 << " has r = " << points[i][0] << ", below the inner radius "
             << inner_radius;
        return text.str();
      }
    const SplineProfile moved   = {points, inner_radius};
    const SplineCurve   contour = moved.contour();
    if (!(moved.height() > 0.))
      return "the last control point is not above the first";
    const unsigned int n_samples = 64 * contour.n_spans();
    for (unsigned int k = 0; k < n_samples; ++k)
    {
      const double t     = (k + 0.5) / n_samples;
      const Vec2   c     = contour.value(t);
      const Vec2   ray   = c - moved.start_of_ray(t);
      const Vec2   slope = contour.derivative(t);
      const double sine  = cross(ray, slope) / (ray.norm() * slope.norm());
      // Less than three degrees between ray and contour leave no room for sound elements.
      if (!(ray[0] > 0.) || !(sine > 0.05))
      {
        text << "the contour crosses itself, folds back or meets the inner line near r = " << c[0]
             << ", z = " << c[1];
        return text.str();
      }
    }
    return "";
  }

  Section SplineProfile::section() const
  {
    const Vec2 low = start_of_ray(0.), high = start_of_ray(1.);
    // Upwards along the inner line, outwards along the top, down the contour, inwards along the bottom.
    Section section = {{inner_radius > 0. ? "side inner" : "", segment(low, high)}};
    if (!is_on_inner_line(control_points.size() - 1))
      section.push_back({"top", segment(high, control_points.back())});
    section.push_back({"side outer", {{control_points.rbegin(), control_points.rend()}, 3}});
    if (!is_on_inner_line(0))
      section.push_back({"bottom", segment(control_points.front(), low)});
    return section;
  }

  // The point lies left of the rays below it, right of those above it: bisection.
  SplineProfile::RayPoint SplineProfile::locate(const Vec2 &x) const
  {
    const SplineCurve curve = contour();
    const auto        ray   = [&](const double t) { return curve.value(t) - start_of_ray(t); };
    double            low = 0., high = 1.;
    for (double t = 0.5; low < t && t < high && high > 1e-17; t = (low + high) / 2.)
      (cross(ray(t), x - start_of_ray(t)) > 0. ? low : high) = t;
    const Vec2   found = ray(high);
    const double along = found * (x - start_of_ray(high)), length = found.norm_square();
    return {high, length > 0. ? std::clamp(along / length, 0., 1.) : 0.};
  }
} // namespace retroforge
