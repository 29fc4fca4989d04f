// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/remeshing/triangle_tree.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace retroforge
{
  namespace
  {
    constexpr unsigned int leaf_size = 4;

    double centre(const std::array<Vec3, 3> &triangle, const unsigned int axis)
    {
      return triangle[0][axis] + triangle[1][axis] + triangle[2][axis];
    }

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
      : triangles_(std::move(triangles)), order_(triangles_.size())
  {
    std::iota(order_.begin(), order_.end(), 0);
    boxes_.push_back({Vec3(), Vec3(), 0, static_cast<unsigned int>(order_.size())});
    for (unsigned int box = 0; box < boxes_.size(); ++box)
      split(box);
  }

  void TriangleTree::split(const unsigned int box)
  {
    const unsigned int begin = boxes_[box].begin, end = boxes_[box].end;
    Vec3               low, high;
    for (unsigned int axis = 0; axis < 3; ++axis)
    {
      low[axis]  = std::numeric_limits<double>::max();
      high[axis] = std::numeric_limits<double>::lowest();
      for (unsigned int i = begin; i < end; ++i)
        for (const Vec3 &corner : triangles_[order_[i]])
        {
          low[axis]  = std::min(low[axis], corner[axis]);
          high[axis] = std::max(high[axis], corner[axis]);
        }
    }
    boxes_[box].low  = low;
    boxes_[box].high = high;
    if (end - begin <= leaf_size)
      return;

    unsigned int axis = 0;
    for (unsigned int other = 1; other < 3; ++other)
      if (high[other] - low[other] > high[axis] - low[axis])
        axis = other;
    const unsigned int middle = (begin + end) / 2;
    std::nth_element(order_.begin() + begin,
                     order_.begin() + middle,
                     order_.begin() + end,
                     [&](const unsigned int a, const unsigned int b) {
                       const double x = centre(triangles_[a], axis), y = centre(triangles_[b], axis);
                       return x != y ? x < y : a < b;
                     });
    boxes_[box].left = boxes_.size();
    boxes_.push_back({low, high, begin, middle});
    boxes_.push_back({low, high, middle, end});
  }

  double TriangleTree::distance_square(const Box &box, const Vec3 &x) const
  {
    double sum = 0;
    for (unsigned int axis = 0; axis < 3; ++axis)
    {
      const double outside = std::max({box.low[axis] - x[axis], x[axis] - box.high[axis], 0.});
      sum += outside * outside;
    }
    return sum;
  }

  void TriangleTree::search(const unsigned int box, const Vec3 &x, double &best, Hit &hit) const
  {
    const Box &here = boxes_[box];
    if (here.left == 0)
    {
      for (unsigned int i = here.begin; i < here.end; ++i)
      {
        const auto   at       = nearest_on_triangle(x, triangles_[order_[i]]);
        const double distance = (x - at.point).norm_square();
        if (distance < best)
        {
          best = distance;
          hit  = {order_[i], at};
        }
      }
      return;
    }
    const double left  = distance_square(boxes_[here.left], x);
    const double right = distance_square(boxes_[here.left + 1], x);
    // The nearer box first: it often excludes the other.
    const bool left_first = left <= right;
    if (std::min(left, right) < best)
      search(left_first ? here.left : here.left + 1, x, best, hit);
    if (std::max(left, right) < best)
      search(left_first ? here.left + 1 : here.left, x, best, hit);
  }

  TriangleTree::Hit TriangleTree::closest(const Vec3 &x) const
  {
    double best = std::numeric_limits<double>::max();
    Hit    hit  = {};
    search(0, x, best, hit);
    return hit;
  }
} // namespace retroforge
