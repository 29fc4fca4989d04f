// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/geometry/vector_algebra.h>
#include <retroforge/output/die_pictures.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    constexpr double margin = 0.1; // of the longer side

    TriangleSurface rectangle_on(const Die &plane, const Vec3 &displacement, const NodalVectors<double> &X)
    {
      const auto at     = plane.project(X[0], displacement, DieFeature());
      const auto across = directions_across(at.n);
      // Along the axes, where the plane is.
      const std::array<Vec3, 2> t = {{-across[1], across[0]}};
      Vec3                      low, high; // along t[0], t[1]
      for (unsigned int i = 0; i < 2; ++i)
      {
        low[i] = high[i] = t[i] * X[0];
        for (const Vec3 &x : X)
        {
          low[i]  = std::min(low[i], t[i] * x);
          high[i] = std::max(high[i], t[i] * x);
        }
      }
      const double wider = margin * std::max(high[0] - low[0], high[1] - low[1]);
      const Vec3   foot  = X[0] + at.delta * at.n;
      const auto   place = [&](const double a, const double b) {
        return foot + (a - t[0] * X[0]) * t[0] + (b - t[1] * X[0]) * t[1];
      };
      const double a0 = low[0] - wider, a1 = high[0] + wider, b0 = low[1] - wider, b1 = high[1] + wider;
      return TriangleSurface("Die " + plane.name,
                             {place(a0, b0), place(a0, b1), place(a1, b1), place(a1, b0)},
                             {{{0, 1, 2}}, {{0, 2, 3}}});
    }
  } // namespace

  TriangleSurface die_picture(const Die &die, const Vec3 &displacement, const NodalVectors<double> &X)
  {
    if (!die.surface())
      return rectangle_on(die, displacement, X);
    TriangleSurface      surface  = *die.surface();
    NodalVectors<double> vertices = surface.vertices();
    for (Vec3 &x : vertices)
      x += displacement;
    surface.move_vertices(std::move(vertices));
    return surface;
  }
} // namespace retroforge
