// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/closest_feature.h>
#include <retroforge/geometry/vector_algebra.h>

#include <utility>

namespace retroforge
{
  /// Signed distance to a die, > 0 outside of it, and the closest feature's normal pointing into the die.
  template <typename Number>
  struct Projection
  {
    Number          delta;
    Vector3<Number> n;
  };

  /// Distance and normal of a given feature of a surface, seen from X with the surface displaced.
  ///
  /// With d = p - X, p the closest point of the plane, line or point that the feature belongs to, and N the
  /// unit normal *into* the die (of a face; mean of both at an edge; weighted by the facets' angles at a
  /// vertex):
  ///   face:          n = N
  ///   edge, vertex:  n = unit vector of  s d + r N,    s = sign(d·N), always 1 on the rim
  ///   delta = d·n
  /// r is TriangleSurface::edge_radius(): n turns from N to d/|d| while the point leaves the edge by r, so that
  /// n, delta and their derivatives stay bounded (|dn/dX| <= 1/r) for a point on the edge, where d/|d| means
  /// nothing. The price: |delta - s|d|| < 0.3 r, less than 0.08 r at edges up to 90 degrees. The sign is
  /// that of the pseudonormal, exact on closed surfaces.
  ///
  /// On the rim of an open surface the distance stays positive: nothing is pushed out from behind.
  ///
  /// @param vertices  of the surface, where a derivative in them is wanted of type Number; r is kept
  template <typename Number, typename VertexNumber>
  Projection<Number> project_on_feature(const TriangleSurface            &surface,
                                        const NodalVectors<VertexNumber> &vertices,
                                        const DieFeature                 &feature,
                                        const Vector3<Number>            &X,
                                        const Vector3<Number>            &displacement);

  /// Adds the pull-back of project_on_feature to X_bar and displacement_bar, and to vertices_bar if given.
  void reverse_project_on_feature(const TriangleSurface &surface,
                                  const DieFeature      &feature,
                                  const Vec3            &X,
                                  const Vec3            &displacement,
                                  double                 delta_bar,
                                  const Vec3            &n_bar,
                                  Vec3                  &X_bar,
                                  Vec3                  &displacement_bar,
                                  NodalVectors<double>  *vertices_bar = nullptr);

  /// An edge that has one facet, or a vertex of such an edge.
  bool is_rim(const TriangleSurface &surface, const DieFeature &feature);

  /// d and N of the formulas above.
  std::pair<Vec3, Vec3>
  offset_and_normal(const TriangleSurface &surface, const DieFeature &feature, const Vec3 &X);
} // namespace retroforge
