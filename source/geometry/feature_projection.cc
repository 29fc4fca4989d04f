// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/dual.h>
#include <retroforge/geometry/feature_projection.h>

#include <cmath>

namespace retroforge
{
  namespace
  {
    /// Vertices as numbers of the type that is computed with.
    template <typename Number, typename VertexNumber>
    class Vertices
    {
    public:
      Vertices(const TriangleSurface &surface, const NodalVectors<VertexNumber> &x) : surface_(surface), x_(x)
      {
      }

      Vector3<Number> corner(const unsigned int facet, const unsigned int c) const
      {
        const Vector3<VertexNumber> &from = x_[surface_.triangles()[facet][c % 3]];
        Vector3<Number>              to;
        for (unsigned int i = 0; i < 3; ++i)
          to[i] = Number(from[i]);
        return to;
      }

      Vector3<Number> facet_normal(const unsigned int facet) const
      {
        return unit(facet_vector(corner(facet, 0), corner(facet, 1), corner(facet, 2)));
      }

      Number angle(const TriangleSurface::Corner &at) const
      {
        using std::atan2;
        const Vector3<Number> x = corner(at.facet, at.corner), a = corner(at.facet, at.corner + 1) - x,
                              b = corner(at.facet, at.corner + 2) - x;
        return atan2(length(cross(a, b)), Number(a * b));
      }

      /// Outward, of any length.
      Vector3<Number> pseudonormal(const DieFeature &feature) const
      {
        Vector3<Number> m = facet_normal(feature.facet);
        if (feature.kind == 0)
          return m;
        if (feature.kind < 4)
        {
          const auto other = surface_.neighbour(feature.facet, feature.kind - 1);
          return other.facet == invalid_index ? m : m + facet_normal(other.facet);
        }
        m = Vector3<Number>();
        for (const auto &at : surface_.around(surface_.triangles()[feature.facet][feature.kind - 4]))
          m += facet_normal(at.facet) * angle(at);
        return m;
      }

      /// d: from X to the closest point of an edge's line or a vertex; of a face, to its first corner.
      Vector3<Number> offset(const DieFeature &feature, const Vector3<Number> &X) const
      {
        if (feature.kind == 0)
          return corner(feature.facet, 0) - X;
        if (feature.kind >= 4)
          return corner(feature.facet, feature.kind - 4) - X;
        const Vector3<Number> a = corner(feature.facet, feature.kind - 1),
                              e = corner(feature.facet, feature.kind) - a, x = X - a;
        return e * Number((x * e) / (e * e)) - x;
      }

    private:
      const TriangleSurface            &surface_;
      const NodalVectors<VertexNumber> &x_;
    };

    double side(const TriangleSurface &surface, const DieFeature &feature, const double depth)
    {
      return depth >= 0. || is_rim(surface, feature) ? 1. : -1.;
    }

    /// The reverse of the parts of a projection, adding to the vertices' derivatives.
    class ReverseVertices
    {
    public:
      ReverseVertices(const TriangleSurface &surface, NodalVectors<double> &bar)
          : surface_(surface), vertices_(surface, surface.vertices()), bar_(bar)
      {
      }

      Vec3 &corner(const unsigned int facet, const unsigned int c)
      {
        return bar_[surface_.triangles()[facet][c % 3]];
      }

      void facet_normal(const unsigned int facet, const Vec3 &m_bar)
      {
        const Vec3 x = vertices_.corner(facet, 0), a = vertices_.corner(facet, 1) - x,
                   b     = vertices_.corner(facet, 2) - x;
        const Vec3 v_bar = reverse_unit(cross(a, b), m_bar);
        const Vec3 a_bar = cross(b, v_bar), b_bar = cross(v_bar, a);
        corner(facet, 1) += a_bar;
        corner(facet, 2) += b_bar;
        corner(facet, 0) -= a_bar + b_bar;
      }

      /// The angle from a to b grows when a turns away from b in their plane, and b from a.
      void angle(const TriangleSurface::Corner &at, const double angle_bar)
      {
        const Vec3 x = vertices_.corner(at.facet, at.corner),
                   a = vertices_.corner(at.facet, at.corner + 1) - x,
                   b = vertices_.corner(at.facet, at.corner + 2) - x, m = unit(cross(a, b));
        const Vec3 a_bar = -angle_bar / (a * a) * cross(m, a), b_bar = angle_bar / (b * b) * cross(m, b);
        corner(at.facet, at.corner + 1) += a_bar;
        corner(at.facet, at.corner + 2) += b_bar;
        corner(at.facet, at.corner) -= a_bar + b_bar;
      }

      void pseudonormal(const DieFeature &feature, const Vec3 &m_bar)
      {
        if (feature.kind < 4)
        {
          facet_normal(feature.facet, m_bar);
          if (feature.kind > 0)
            if (const auto other = surface_.neighbour(feature.facet, feature.kind - 1);
                other.facet != invalid_index)
              facet_normal(other.facet, m_bar);
          return;
        }
        for (const auto &at : surface_.around(surface_.triangles()[feature.facet][feature.kind - 4]))
        {
          facet_normal(at.facet, vertices_.angle(at) * m_bar);
          angle(at, vertices_.facet_normal(at.facet) * m_bar);
        }
      }

      void offset(const DieFeature &feature, const Vec3 &X, const Vec3 &d_bar)
      {
        if (feature.kind == 0)
          corner(feature.facet, 0) += d_bar;
        else if (feature.kind >= 4)
          corner(feature.facet, feature.kind - 4) += d_bar;
        else
        {
          // d = a + t e - X,  t = (X - a)·e / e·e
          const Vec3   a = vertices_.corner(feature.facet, feature.kind - 1);
          const Vec3   e = vertices_.corner(feature.facet, feature.kind) - a;
          const double t = ((X - a) * e) / (e * e), t_bar = d_bar * e;
          const Vec3   e_bar = t * d_bar + t_bar / (e * e) * (X - a - 2. * t * e);
          corner(feature.facet, feature.kind) += e_bar;
          corner(feature.facet, feature.kind - 1) += d_bar - t_bar / (e * e) * e - e_bar;
        }
      }

    private:
      const TriangleSurface   &surface_;
      Vertices<double, double> vertices_;
      NodalVectors<double>    &bar_;
    };
  } // namespace

  bool is_rim(const TriangleSurface &surface, const DieFeature &feature)
  {
    if (feature.kind == 0)
      return false;
    return feature.kind < 4 ? surface.neighbour(feature.facet, feature.kind - 1).facet == invalid_index
                            : surface.on_rim(surface.triangles()[feature.facet][feature.kind - 4]);
  }

  std::pair<Vec3, Vec3>
  offset_and_normal(const TriangleSurface &surface, const DieFeature &feature, const Vec3 &X)
  {
    const Vertices<double, double> vertices(surface, surface.vertices());
    return {vertices.offset(feature, X), -unit(vertices.pseudonormal(feature))};
  }

  template <typename Number, typename VertexNumber>
  Projection<Number> project_on_feature(const TriangleSurface            &surface,
                                        const NodalVectors<VertexNumber> &vertices,
                                        const DieFeature                 &feature,
                                        const Vector3<Number>            &X,
                                        const Vector3<Number>            &displacement)
  {
    const Vertices<Number, VertexNumber> at(surface, vertices);
    const Vector3<Number>                d = at.offset(feature, Vector3<Number>(X - displacement));
    Projection<Number>                   projection;
    projection.n = -unit(at.pseudonormal(feature));
    if (feature.kind > 0)
    {
      const double s = side(surface, feature, value_of(Number(d * projection.n)));
      projection.n   = unit(Vector3<Number>(d * Number(s) + projection.n * Number(surface.edge_radius())));
    }
    projection.delta = d * projection.n;
    return projection;
  }

  void reverse_project_on_feature(const TriangleSurface &surface,
                                  const DieFeature      &feature,
                                  const Vec3            &X,
                                  const Vec3            &displacement,
                                  const double           delta_bar,
                                  const Vec3            &n_bar,
                                  Vec3                  &X_bar,
                                  Vec3                  &displacement_bar,
                                  NodalVectors<double>  *vertices_bar)
  {
    const Vertices<double, double> at(surface, surface.vertices());
    const Vec3                     x = X - displacement, d = at.offset(feature, x);
    const Vec3                     m = at.pseudonormal(feature), N = -unit(m);
    Vec3                           n = N, d_bar, N_bar = n_bar + delta_bar * d;
    if (feature.kind > 0)
    {
      const double s     = side(surface, feature, d * N);
      const Vec3   w     = s * d + surface.edge_radius() * N;
      const Vec3   w_bar = reverse_unit(w, N_bar);
      n                  = unit(w);
      d_bar              = s * w_bar;
      N_bar              = surface.edge_radius() * w_bar;
    }
    d_bar += delta_bar * n;
    // d = p - X: p depends on X only along an edge, and there d only across it.
    Vec3 x_bar = -d_bar;
    if (feature.kind > 0 && feature.kind < 4)
    {
      const Vec3 e =
        unit(Vec3(at.corner(feature.facet, feature.kind) - at.corner(feature.facet, feature.kind - 1)));
      x_bar += (d_bar * e) * e;
    }
    X_bar += x_bar;
    displacement_bar -= x_bar;
    if (!vertices_bar)
      return;
    ReverseVertices reverse(surface, *vertices_bar);
    reverse.offset(feature, x, d_bar);
    reverse.pseudonormal(feature, -reverse_unit(m, N_bar));
  }

#define RETROFORGE_INSTANTIATE(Number, VertexNumber)                                 \
  template Projection<Number> project_on_feature(const TriangleSurface &,            \
                                                 const NodalVectors<VertexNumber> &, \
                                                 const DieFeature &,                 \
                                                 const Vector3<Number> &,            \
                                                 const Vector3<Number> &);
  RETROFORGE_INSTANTIATE(double, double)
  RETROFORGE_INSTANTIATE(Dual, double)
  RETROFORGE_INSTANTIATE(Dual, Dual)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
