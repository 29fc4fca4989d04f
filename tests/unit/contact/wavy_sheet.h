// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/triangle_surface.h>

#include <cmath>

namespace retroforge
{
  /// A wavy sheet over [-8, 8]^2 near z = 0.1, for a billet that stands at the origin: its edges and vertices
  /// are included, normals point up, and its hills bulge into edges of the billet.
  /// @param height  of the hills [mm]
  inline TriangleSurface wavy_sheet(const double height = 0.3)
  {
    const unsigned int    n = 8;
    NodalVectors<double>  x;
    std::vector<Triangle> t;
    for (unsigned int j = 0; j <= n; ++j)
      for (unsigned int i = 0; i <= n; ++i)
      {
        const double a = -8. + 16. * i / n, b = -8. + 16. * j / n;
        x.push_back(Vec3({a, b, 0.1 + height * std::sin(a + 0.4) * std::cos(0.8 * b)}));
      }
    for (unsigned int j = 0; j < n; ++j)
      for (unsigned int i = 0; i < n; ++i)
      {
        const unsigned int k = j * (n + 1) + i;
        t.insert(t.end(), {{{k, k + 1, k + n + 2}}, {{k, k + n + 2, k + n + 1}}});
      }
    return TriangleSurface("sheet", x, t);
  }
} // namespace retroforge
