// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/design/billet_shapes.h>

#include <cmath>

namespace retroforge
{
  namespace
  {
    // Which coordinate of which control point each parameter is.
    struct Coordinate
    {
      unsigned int point, component;
    };

    std::vector<Coordinate> free_coordinates(const SplineProfile &profile)
    {
      std::vector<Coordinate> coordinates;
      const unsigned int      last = profile.control_points.size() - 1;
      for (unsigned int i = 0; i <= last; ++i)
      {
        // An end of the contour on the inner line must stay there, or a level disc would open.
        if (!((i == 0 || i == last) && profile.is_on_inner_line(i)))
          coordinates.push_back({i, 0});
        coordinates.push_back({i, 1});
      }
      return coordinates;
    }

    std::vector<Vec2> moved_points(const SplineProfile           &profile,
                                   const std::vector<Coordinate> &coordinates,
                                   const std::vector<double>     &mu)
    {
      std::vector<Vec2> points = profile.control_points;
      for (unsigned int j = 0; j < mu.size(); ++j)
        points[coordinates[j].point][coordinates[j].component] = mu[j];
      return points;
    }
  } // namespace

  BilletShapes profile_shapes(const BilletParameters &billet, const NodalVectors<double> &X)
  {
    const SplineProfile         profile     = billet.profile;
    const SplineCurve           contour     = profile.contour();
    const auto                  coordinates = free_coordinates(profile);
    const unsigned int          last        = profile.control_points.size() - 1;
    std::vector<ShapeParameter> parameters;
    for (const auto [i, component] : coordinates)
      parameters.push_back({"control point " + std::to_string(i + 1) + (component == 0 ? " r" : " z"),
                            "mm",
                            profile.control_points[i][component],
                            profile.width() / 2.,
                            {}});
    for (const Vec3 &x : X)
    {
      const double r        = std::hypot(x[0], x[1]);
      const Vec3   outwards = r > 0. ? Vec3({x[0] / r, x[1] / r, 0.}) : Vec3();
      const auto [t, s]     = profile.locate(Vec2({r, x[2]}));
      const auto B          = contour.basis(t);
      for (unsigned int j = 0; j < parameters.size(); ++j)
      {
        const auto [i, component] = coordinates[j];
        // Rays begin between the heights of the contour's ends.
        const double start = i == 0 ? 1. - t : i == last ? t : 0.;
        parameters[j].direction.push_back(
          component == 0 ? s * B[i] * outwards : (s * B[i] + (1. - s) * start) * Vec3({0., 0., 1.}));
      }
    }
    return {parameters,
            [profile, coordinates](const std::vector<double> &mu) {
              return profile.complaint(moved_points(profile, coordinates, mu));
            },
            [billet, coordinates](const std::vector<double> &mu) {
              BilletParameters measured       = billet;
              measured.profile.control_points = moved_points(billet.profile, coordinates, mu);
              return measured;
            }};
  }
} // namespace retroforge
