// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/box_tree.h>

#include <vector>

namespace retroforge
{
  /// The point of a triangle next to a given one, and its barycentric coordinates.
  struct TrianglePoint
  {
    Vec3                  point;
    std::array<double, 3> lambda;
  };

  TrianglePoint nearest_on_triangle(const Vec3 &x, const std::array<Vec3, 3> &triangle);

  /// Parameter in [0, 1] of the point of the segment a-b next to x.
  double nearest_on_segment(const Vec3 &x, const Vec3 &a, const Vec3 &b);

  /// Smallest distance of two segments a-b and c-d.
  double segment_distance(const Vec3 &a, const Vec3 &b, const Vec3 &c, const Vec3 &d);

  /// Finds the closest of a set of triangles, in logarithmic time.
  class TriangleTree
  {
  public:
    struct Hit
    {
      unsigned int  triangle; ///< its index in the list given to the constructor
      TrianglePoint at;
    };

    TriangleTree() = default;
    explicit TriangleTree(std::vector<std::array<Vec3, 3>> triangles);

    /// Returns the closest triangle; of several that are equally close, the first in the list.
    Hit closest(const Vec3 &x) const;

  private:
    std::vector<std::array<Vec3, 3>> triangles_;
    BoxTree                          tree_;
  };
} // namespace retroforge
