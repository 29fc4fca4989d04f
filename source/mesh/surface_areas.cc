// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/surface_areas.h>

#include <algorithm>

namespace retroforge
{
  void reverse_triangle_area(const Triangle             &triangle,
                             const NodalVectors<double> &x,
                             const double                area_bar,
                             NodalVectors<double>       &x_bar)
  {
    const Vec3 &a = x[triangle[0]], &b = x[triangle[1]], &c = x[triangle[2]];
    const Vec3  v      = facet_vector(a, b, c);
    const Vec3  normal = 0.5 * area_bar / v.norm() * v;
    // Each corner moves the area by half the opposite edge, across it in the plane of the triangle.
    x_bar[triangle[0]] += cross_product_3d(b - c, normal);
    x_bar[triangle[1]] += cross_product_3d(c - a, normal);
    x_bar[triangle[2]] += cross_product_3d(a - b, normal);
  }

  void reverse_lumped_areas(const std::vector<Triangle> &triangles,
                            const NodalVectors<double>  &x,
                            const std::vector<double>   &areas_bar,
                            NodalVectors<double>        &x_bar)
  {
    for (const Triangle &t : triangles)
      if (const double third_bar = (areas_bar[t[0]] + areas_bar[t[1]] + areas_bar[t[2]]) / 3.;
          third_bar != 0.)
        reverse_triangle_area(t, x, third_bar, x_bar);
  }

  std::vector<Triangle> surface_triangles(const TetMesh &mesh)
  {
    std::vector<Triangle> triangles;
    for (const BoundaryFace &face : mesh.faces)
      if (mesh.is_surface(face))
        triangles.push_back(face.nodes);
    return triangles;
  }

  CellIndex cell_at(const Topology &topology, const BoundaryFace &face)
  {
    for (const CellIndex c : topology.cells[face.nodes[0]])
      if (std::all_of(face.nodes.begin() + 1, face.nodes.end(), [&](const NodeIndex k) {
            const auto cells = topology.cells[k];
            return std::binary_search(cells.begin(), cells.end(), c);
          }))
        return c;
    return invalid_index;
  }
} // namespace retroforge
