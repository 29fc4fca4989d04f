// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/triangle_surface.h>
#include <retroforge/geometry/vector_algebra.h>

namespace retroforge
{
  /// Normals at the corners of the facets of a surface that stands for a smooth one.
  ///
  /// An edge is sharp where the facets turn by more than the feature angle, or where a smooth surface through
  /// it would be farther from its facets than their makers would have left it: a fold between two large faces
  /// is an edge although it turns by little. Around a vertex the facets fall into fans between sharp edges,
  /// and each fan has one normal. With u and v from the vertex a along the edges of a facet,
  ///   n = unit( sum_f u x v / (|u|^2 |v|^2) )
  /// which is exact for vertices on a sphere, and for quadrangles halved along either diagonal the same (Max,
  /// Weights for computing vertex normals from facet normals, 1999). Facets of a flat region much smaller
  /// than the fan's largest one are left out of the sum: where a flat face runs into a small rounding, the
  /// smooth surface has the face's normal, and the face stays flat. Which facets count is decided once, from
  /// the surface as it was made, and kept when vertices move: so normals are a differentiable function of the
  /// vertices.
  class CornerNormals
  {
  public:
    /// @param feature_angle    [degrees]
    /// @param largest_sagitta  of the surface's diagonal
    CornerNormals(const TriangleSurface &surface, double feature_angle, double largest_sagitta = 3e-3);

    /// Returns the number of a corner's normal. Corners of one fan share theirs.
    unsigned int of_corner(const unsigned int facet, const unsigned int corner) const
    {
      return normal_of_corner_[facet][corner];
    }

    /// Returns whether the surface ends or turns by more than the feature angle at an edge.
    bool is_sharp(const unsigned int facet, const unsigned int edge) const { return sharp_[facet][edge]; }

    /// Returns whether the vertex lies on a sharp edge.
    bool is_on_sharp_edge(const unsigned int vertex) const { return on_sharp_edge_[vertex]; }

    /// The corners of facets that a normal sums up.
    const std::vector<TriangleSurface::Corner> &corners(const unsigned int normal) const
    {
      return corners_[normal];
    }

    /// A normal at the vertices the surface has.
    const Vec3 &operator[](const unsigned int normal) const { return values_[normal]; }

    /// Recomputes the normals with the surface's vertices elsewhere.
    void update(const TriangleSurface &surface);

    /// A normal with the vertices at x.
    template <typename Number, typename VertexNumber>
    Vector3<Number> normal(const TriangleSurface            &surface,
                           const NodalVectors<VertexNumber> &x,
                           const unsigned int                normal) const
    {
      Vector3<Number> sum;
      for (const auto &at : corners_[normal])
      {
        const Triangle             &t = surface.triangles()[at.facet];
        const Vector3<VertexNumber> u = x[t[(at.corner + 1) % 3]] - x[t[at.corner]],
                                    v = x[t[(at.corner + 2) % 3]] - x[t[at.corner]], w = cross(u, v);
        const VertexNumber scale = 1. / ((u * u) * (v * v));
        for (unsigned int i = 0; i < 3; ++i)
          sum[i] += Number(scale * w[i]);
      }
      return unit(sum);
    }

    /// Pull-back of normal() at the surface's own vertices: adds to x_bar.
    void reverse_normal(const TriangleSurface &surface,
                        unsigned int           normal,
                        const Vec3            &normal_bar,
                        NodalVectors<double>  &x_bar) const;

  private:
    std::vector<std::array<unsigned int, 3>>          normal_of_corner_;
    std::vector<std::array<bool, 3>>                  sharp_;
    std::vector<bool>                                 on_sharp_edge_;
    std::vector<std::vector<TriangleSurface::Corner>> corners_;
    std::vector<Vec3>                                 values_;
  };
} // namespace retroforge
