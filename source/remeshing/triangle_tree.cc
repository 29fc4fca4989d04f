// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/remeshing/triangle_tree.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace retroforge
{
  namespace
  {
    TrianglePoint closest_on_rim(const Vec3 &x, const std::array<Vec3, 3> &triangle)
    {
      TrianglePoint best;
      double        distance = std::numeric_limits<double>::max();
      for (unsigned int i = 0; i < 3; ++i)
      {
        const unsigned int j = (i + 1) % 3;
        const double       t = nearest_on_segment(x, triangle[i], triangle[j]);
        const Vec3         p = (1 - t) * triangle[i] + t * triangle[j];
        if ((x - p).norm_square() < distance)
        {
          distance       = (x - p).norm_square();
          best.point     = p;
          best.lambda    = {{0, 0, 0}};
          best.lambda[i] = 1 - t;
          best.lambda[j] = t;
        }
      }
      return best;
    }
  } // namespace

  double nearest_on_segment(const Vec3 &x, const Vec3 &a, const Vec3 &b)
  {
    const double length_square = (b - a).norm_square();
    if (!(length_square > 0))
      return 0;
    return std::clamp((x - a) * (b - a) / length_square, 0., 1.);
  }

  TrianglePoint nearest_on_triangle(const Vec3 &x, const std::array<Vec3, 3> &triangle)
  {
    const Vec3   u = triangle[1] - triangle[0], v = triangle[2] - triangle[0], w = x - triangle[0];
    const Vec3   normal = cross_product_3d(u, v);
    const double square = normal.norm_square();
    if (square > 0)
    {
      const double l1 = cross_product_3d(w, v) * normal / square;
      const double l2 = cross_product_3d(u, w) * normal / square;
      if (l1 >= 0 && l2 >= 0 && l1 + l2 <= 1)
        return {triangle[0] + l1 * u + l2 * v, {{1 - l1 - l2, l1, l2}}};
    }
    return closest_on_rim(x, triangle);
  }

  double segment_distance(const Vec3 &a, const Vec3 &b, const Vec3 &c, const Vec3 &d)
  {
    const Vec3   normal = cross_product_3d(b - a, d - c);
    const double square = normal.norm_square();
    if (square > 0)
    {
      const double s = cross_product_3d(c - a, d - c) * normal / square;
      const double t = cross_product_3d(c - a, b - a) * normal / square;
      if (s >= 0 && s <= 1 && t >= 0 && t <= 1)
        return std::abs((c - a) * normal) / std::sqrt(square);
    }
    const auto to = [](const Vec3 &x, const Vec3 &p, const Vec3 &q) {
      const double t = nearest_on_segment(x, p, q);
      return (x - (1 - t) * p - t * q).norm();
    };
    return std::min({to(a, c, d), to(b, c, d), to(c, a, b), to(d, a, b)});
  }

  TriangleTree::TriangleTree(std::vector<std::array<Vec3, 3>> triangles)
      : triangles_(std::move(triangles))
      , tree_(std::vector<BoundingBox>(triangles_.begin(), triangles_.end()))
  {
  }

  TriangleTree::Hit TriangleTree::closest(const Vec3 &x) const
  {
    const unsigned int triangle = tree_.closest(x, [&](const unsigned int i) {
      return (x - nearest_on_triangle(x, triangles_[i]).point).norm_square();
    });
    return {triangle, nearest_on_triangle(x, triangles_[triangle])};
  }
} // namespace retroforge
