// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/dual.h>
#include <retroforge/geometry/vector_algebra.h>

/// @file
/// What planes leave of tetrahedra and triangles, for numbers of any type. Nothing is decided: volumes and
/// areas are continuous in all arguments with their first derivatives, but where a face lies in a plane.
namespace retroforge
{
  /// The points with  normal·x <= offset.
  template <typename Number>
  struct HalfSpace
  {
    Vector3<Number> normal; ///< of any length
    Number          offset;

    Number excess(const Vector3<Number> &x) const { return normal * x - offset; }
  };

  template <typename Number>
  using Tetrahedron = std::array<Vector3<Number>, 4>;

  /// Volume of a tetrahedron, > 0 where (x1 - x0) x (x2 - x0)·(x3 - x0) is [mm^3].
  template <typename Number>
  Number signed_volume(const Tetrahedron<Number> &x)
  {
    return Number(cross<Number>(x[1] - x[0], x[2] - x[0]) * (x[3] - x[0])) / 6.;
  }

  namespace internal
  {
    /// Sorts the corners inside of a half-space to the front, by pairwise exchange of two corners: an odd one
    /// turns the tetrahedron over, and then two of the corners in front or behind are exchanged, too.
    /// @return the number inside
    template <typename Number, std::size_t n>
    unsigned int sort_inside_first(std::array<Vector3<Number>, n> &x, std::array<Number, n> &excess)
    {
      unsigned int n_inside = 0;
      bool         odd      = false;
      for (unsigned int k = 0; k < n; ++k)
        if (value_of(excess[k]) <= 0.)
        {
          if (k != n_inside)
          {
            std::swap(x[k], x[n_inside]);
            std::swap(excess[k], excess[n_inside]);
            odd = !odd;
          }
          ++n_inside;
        }
      if (odd)
      {
        const unsigned int a = n_inside >= 2 ? 0 : n - 2;
        std::swap(x[a], x[a + 1]);
        std::swap(excess[a], excess[a + 1]);
      }
      return n_inside;
    }

    /// The corners of a simplex, sorted, and the points where its edges meet the plane.
    template <typename Number, std::size_t n>
    struct SimplexCut
    {
      std::array<Vector3<Number>, n> x;
      std::array<Number, n>          excess;
      unsigned int                   n_inside;

      SimplexCut(const std::array<Vector3<Number>, n> &corners, const HalfSpace<Number> &space) : x(corners)
      {
        for (unsigned int k = 0; k < n; ++k)
          excess[k] = space.excess(x[k]);
        n_inside = sort_inside_first(x, excess);
      }

      Vector3<Number> point(const unsigned int inside, const unsigned int outside) const
      {
        return x[inside] +
               (x[outside] - x[inside]) * Number(excess[inside] / (excess[inside] - excess[outside]));
      }
    };
  } // namespace internal

  /// Signed volume of the part of a tetrahedron that lies in all half-spaces [mm^3].
  template <typename Number>
  Number clipped_volume(const Tetrahedron<Number> &tetrahedron,
                        const HalfSpace<Number>   *begin,
                        const HalfSpace<Number>   *end)
  {
    for (; begin != end; ++begin)
    {
      unsigned int n_inside = 0;
      for (const auto &x : tetrahedron)
        n_inside += value_of(begin->excess(x)) <= 0. ? 1 : 0;
      if (n_inside == 0)
        return Number(0.);
      if (n_inside == 4)
        continue;
      const internal::SimplexCut<Number, 4> cut(tetrahedron, *begin);
      const auto                           &x      = cut.x;
      const auto                            volume = [&](const Vector3<Number> &a,
                              const Vector3<Number> &b,
                              const Vector3<Number> &c,
                              const Vector3<Number> &d) {
        return clipped_volume(Tetrahedron<Number>{{a, b, c, d}}, begin + 1, end);
      };
      if (n_inside == 1)
        return volume(x[0], cut.point(0, 1), cut.point(0, 2), cut.point(0, 3));
      if (n_inside == 2)
      {
        const Vector3<Number> ac = cut.point(0, 2), ad = cut.point(0, 3), bc = cut.point(1, 2),
                              bd = cut.point(1, 3);
        return volume(x[0], x[1], ac, ad) + volume(ac, x[1], bc, ad) + volume(ad, x[1], bc, bd);
      }
      // All but a corner: where an edge lies in the plane, rounding says where they meet, and the place's
      // derivative is huge, but not that of the corner's volume.
      return volume(x[0], x[1], x[2], x[3]) - volume(cut.point(0, 3), cut.point(1, 3), cut.point(2, 3), x[3]);
    }
    return signed_volume(tetrahedron);
  }

  /// Area vector, half of facet_vector(), of the part of a triangle that lies in all half-spaces [mm^2].
  template <typename Number>
  Vector3<Number> clipped_area(const std::array<Vector3<Number>, 3> &triangle,
                               const HalfSpace<Number>              *begin,
                               const HalfSpace<Number>              *end)
  {
    for (; begin != end; ++begin)
    {
      const internal::SimplexCut<Number, 3> cut(triangle, *begin);
      const auto                           &x = cut.x;
      const auto area = [&](const Vector3<Number> &a, const Vector3<Number> &b, const Vector3<Number> &c) {
        return clipped_area(std::array<Vector3<Number>, 3>{{a, b, c}}, begin + 1, end);
      };
      if (cut.n_inside == 0)
        return Vector3<Number>();
      if (cut.n_inside == 1)
        return area(x[0], cut.point(0, 1), cut.point(0, 2));
      if (cut.n_inside == 2)
        return area(x[0], x[1], x[2]) - area(cut.point(0, 2), cut.point(1, 2), x[2]);
    }
    return cross<Number>(triangle[1] - triangle[0], triangle[2] - triangle[0]) * Number(0.5);
  }
} // namespace retroforge
