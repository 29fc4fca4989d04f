// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/tet_mesh.h>

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

  /// Finds the closest of a set of triangles by a tree of boxes, in logarithmic time.
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

    /// Among equally close triangles, the first the walk meets: the same for the same input.
    Hit closest(const Vec3 &x) const;

  private:
    // Children of box k are the boxes `left` and `left + 1`; a leaf has left = 0.
    struct Box
    {
      Vec3         low, high;
      unsigned int begin, end;
      unsigned int left = 0;
    };

    void   split(unsigned int box);
    void   search(unsigned int box, const Vec3 &x, double &best, Hit &hit) const;
    double distance_square(const Box &box, const Vec3 &x) const;

    std::vector<std::array<Vec3, 3>> triangles_;
    std::vector<unsigned int>        order_;
    std::vector<Box>                 boxes_;
  };
} // namespace retroforge
