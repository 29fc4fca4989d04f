// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/triangle_surface.h>
#include <retroforge/mesh/topology.h>

namespace retroforge
{
  /// Returns |(b - a) x (c - a)| / 2.
  template <typename Number>
  Number triangle_area(const Triangle &triangle, const NodalVectors<Number> &x)
  {
    using std::sqrt;
    const Vector3<Number> v = facet_vector(x[triangle[0]], x[triangle[1]], x[triangle[2]]);
    return 0.5 * sqrt(Number(v * v));
  }

  /// Adds area_bar times the derivatives of triangle_area to x_bar.
  void reverse_triangle_area(const Triangle             &triangle,
                             const NodalVectors<double> &x,
                             double                      area_bar,
                             NodalVectors<double>       &x_bar);

  /// Returns one third of the areas of the triangles at each point.
  template <typename Number>
  std::vector<Number> lumped_areas(const std::vector<Triangle> &triangles, const NodalVectors<Number> &x)
  {
    std::vector<Number> areas(x.size(), Number(0.));
    for (const Triangle &triangle : triangles)
    {
      const Number third = triangle_area(triangle, x) / 3.;
      for (const unsigned int v : triangle)
        areas[v] += third;
    }
    return areas;
  }

  /// Adds the pull-back of lumped_areas to x_bar.
  void reverse_lumped_areas(const std::vector<Triangle> &triangles,
                            const NodalVectors<double>  &x,
                            const std::vector<double>   &areas_bar,
                            NodalVectors<double>        &x_bar);

  /// Returns the nodes of all surface faces, turned as they are.
  std::vector<Triangle> surface_triangles(const TetMesh &mesh);

  /// Returns the cell that a face of the boundary belongs to.
  CellIndex cell_at(const Topology &topology, const BoundaryFace &face);
} // namespace retroforge
