// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/corner_normals.h>
#include <retroforge/geometry/feature_projection.h>

/// @file
/// Distance and normal of a triangulated surface that stands for a smooth one.
///
/// With barycentric coordinates l_a over a facet of corners x_a and corner normals n_a (CornerNormals), the
/// foot of a point X is where the interpolated normal goes through it:
///   sum_a l_a x_a + d N(l) = X,   N(l) = sum_a l_a n_a
/// Along an edge it depends on the edge's ends alone. So foot, normal and gap are continuous from facet to
/// facet, on both sides of the surface, and no point belongs to an edge or vertex inside a smooth patch. The
/// foot is lifted onto the smooth surface by Phong tessellation with factor 1/2, exact for quadratic ones:
///   p = p0 + 1/2 sum_a l_a ((x_a - p0)·n_a) n_a,   n = -N/|N|,   delta = (p - X)·n
/// The coordinates follow X, the displacement and the vertices: all of it is differentiated.
namespace retroforge
{
  /// The face of a facet, interpolated, that X stands over; an edge or a vertex where the surface is sharp.
  /// @param closest  the closest feature of the facets as they are
  DieFeature feature_of_smooth_surface(const TriangleSurface &surface,
                                       const CornerNormals   &normals,
                                       const DieFeature      &closest,
                                       const Vec3            &X);

  /// Distance and normal of a feature that feature_of_smooth_surface() may give, seen from X. Of sharp edges
  /// and their vertices they are those of project_on_feature().
  /// @param vertices  of the surface; null: as made
  template <typename Number, typename VertexNumber>
  Projection<Number> project_smoothly(const TriangleSurface            &surface,
                                      const CornerNormals              &normals,
                                      const NodalVectors<VertexNumber> *vertices,
                                      const DieFeature                 &feature,
                                      const Vector3<Number>            &X,
                                      const Vector3<Number>            &displacement);

  /// Adds the pull-back of project_smoothly to X_bar and displacement_bar, and to vertices_bar if given.
  void reverse_project_smoothly(const TriangleSurface &surface,
                                const CornerNormals   &normals,
                                const DieFeature      &feature,
                                const Vec3            &X,
                                const Vec3            &displacement,
                                double                 delta_bar,
                                const Vec3            &n_bar,
                                Vec3                  &X_bar,
                                Vec3                  &displacement_bar,
                                NodalVectors<double>  *vertices_bar = nullptr);
} // namespace retroforge
