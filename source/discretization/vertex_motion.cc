// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/dual.h>
#include <retroforge/discretization/vertex_motion.h>
#include <retroforge/geometry/vector_algebra.h>

namespace retroforge
{
  namespace
  {
    template <typename Number>
    struct SurfaceFace
    {
      std::array<NodeIndex, 3> nodes;
      std::array<NodeIndex, 3> middles;
      Vector3<Number>          s;      ///< area vector [mm^2]
      Vector3<Number>          defect; ///< mean of the middles minus mean of the vertices [mm/s]

      Number D() const { return s * defect; }
    };

    /// Quantities at vertices of the surface; vertices inside keep zeros.
    template <typename Number>
    struct SurfaceVertex
    {
      Vector3<Number> t;              ///< N without fixed directions [mm^2]
      Number          A = Number(0.); ///< [mm^2]
      Number          e = Number(0.), b = Number(0.);
      Number          u    = Number(0.); ///< what of a flux it may take
      Number          free = Number(0.); ///< flux over freedom that it takes as a free vertex [mm^3/s]
      Number          held = Number(0.); ///< flux that it takes as one of three held ones [mm^3/s]

      Number          z(const Number &freedom) const { return freedom * free + held; }
      Vector3<Number> r() const { return t * Number(b / (A * A)); }
    };

    /// b(e), smooth at the least effective normal and at zero.
    template <typename Number>
    Number answer(const Number &e)
    {
      constexpr double e_min = least_effective_normal;
      if (value_of(e) >= e_min)
        return 1. / e;
      const Number x = e / e_min;
      return x * (3. - 2. * x) / e_min;
    }

    double answer_slope(const double e)
    {
      constexpr double e_min = least_effective_normal;
      return e >= e_min ? -1. / (e * e) : (3. - 4. * e / e_min) / (e_min * e_min);
    }

    /// g(u, v)
    template <typename Number>
    Number left_by_others(const Number &u, const Number &v)
    {
      return 1. - 0.5 * (u + v) + u * v / 3.;
    }

    /// A third of the chance that none of the three is at large.
    template <typename Number>
    Number third_if_held(const Number &u, const Number &v, const Number &w)
    {
      return (1. - u) * (1. - v) * (1. - w) / 3.;
    }

    template <typename Number>
    Vector3<Number> in_free_directions(Vector3<Number> N, const dealii::ArrayView<const Vec3> &fixed)
    {
      for (const Vec3 &direction : fixed)
      {
        const Number along = N * direction;
        for (unsigned int i = 0; i < 3; ++i)
          N[i] -= along * direction[i];
      }
      return N;
    }

    template <typename Number>
    void check_sizes([[maybe_unused]] const VertexMotionInput<Number> &in)
    {
      AssertDimension(in.X.size(), in.mesh.n_nodes());
      AssertDimension(in.V.size(), in.mesh.n_nodes() + in.middles.size());
      AssertDimension(in.freedom.size(), in.mesh.n_nodes());
    }

    template <typename Number>
    std::vector<SurfaceFace<Number>> faces_of_surface(const VertexMotionInput<Number> &in)
    {
      std::vector<SurfaceFace<Number>> faces;
      for (unsigned int f = 0; f < in.mesh.faces.size(); ++f)
      {
        if (!in.mesh.is_surface(in.mesh.faces[f]))
          continue;
        const auto         &n = in.mesh.faces[f].nodes;
        SurfaceFace<Number> face{
          n,
          {{in.middles.between(n[0], n[1]), in.middles.between(n[1], n[2]), in.middles.between(n[2], n[0])}},
          {},
          {}};
        const auto &X0 = in.X[face.nodes[0]];
        face.s = cross(Vector3<Number>(in.X[face.nodes[1]] - X0), Vector3<Number>(in.X[face.nodes[2]] - X0)) *
                 Number(0.5);
        for (unsigned int i = 0; i < 3; ++i)
          face.defect += in.V[face.middles[i]] - in.V[face.nodes[i]];
        face.defect *= Number(1. / 3.);
        faces.push_back(face);
      }
      return faces;
    }

    template <typename Number>
    std::vector<SurfaceVertex<Number>> vertices_of_surface(const VertexMotionInput<Number>        &in,
                                                           const std::vector<SurfaceFace<Number>> &faces)
    {
      std::vector<SurfaceVertex<Number>> vertices(in.mesh.n_nodes());
      for (const auto &face : faces)
        for (const NodeIndex k : face.nodes)
        {
          vertices[k].t += face.s * Number(1. / 3.);
          vertices[k].A += length(face.s) / 3.;
        }
      for (NodeIndex k = 0; k < vertices.size(); ++k)
        if (in.topology.is_on_surface(k))
        {
          auto &vertex = vertices[k];
          vertex.t     = in_free_directions(vertex.t, in.topology.fixed_directions[k]);
          vertex.e     = vertex.t * vertex.t / (vertex.A * vertex.A);
          vertex.b     = answer(vertex.e);
          vertex.u     = in.freedom[k] * vertex.e * vertex.b;
        }
      for (const auto &face : faces)
      {
        const Number D = face.D();
        for (unsigned int i = 0; i < 3; ++i)
        {
          auto       &vertex = vertices[face.nodes[i]];
          const auto &u = vertices[face.nodes[(i + 1) % 3]].u, &v = vertices[face.nodes[(i + 2) % 3]].u;
          vertex.free += D * left_by_others(u, v);
          vertex.held += D * third_if_held(vertex.u, u, v);
        }
      }
      return vertices;
    }

    /// Reverses the flux of one face and the shares of its vertices.
    /// @param free_bar, held_bar  of the vertices' parts
    double reverse_sharing(const SurfaceFace<double>                &face,
                           const std::vector<SurfaceVertex<double>> &vertices,
                           const std::vector<double>                &free_bar,
                           const std::vector<double>                &held_bar,
                           std::vector<double>                      &u_bar)
    {
      const double D     = face.D();
      double       D_bar = 0.;
      for (unsigned int i = 0; i < 3; ++i)
      {
        const NodeIndex j = face.nodes[(i + 1) % 3], k = face.nodes[(i + 2) % 3];
        const double    z = free_bar[face.nodes[i]], h = held_bar[face.nodes[i]];
        const double    own = vertices[face.nodes[i]].u, u = vertices[j].u, v = vertices[k].u;
        D_bar += z * left_by_others(u, v) + h * third_if_held(own, u, v);
        u_bar[face.nodes[i]] -= h * D * (1. - u) * (1. - v) / 3.;
        u_bar[j] += z * D * (v / 3. - 0.5) - h * D * (1. - own) * (1. - v) / 3.;
        u_bar[k] += z * D * (u / 3. - 0.5) - h * D * (1. - own) * (1. - u) / 3.;
      }
      return D_bar;
    }

    /// Pull-back of r = b(e) t/A^2 and of a = e b(e).
    struct NormalBar
    {
      Vec3   N;
      double A;
    };

    NormalBar reverse_normal(const SurfaceVertex<double>         &vertex,
                             const dealii::ArrayView<const Vec3> &fixed,
                             const Vec3                          &r_bar,
                             const double                         a_bar)
    {
      const double slope = answer_slope(vertex.e), A2 = vertex.A * vertex.A;
      const double along = vertex.t * r_bar;
      const double e_bar = slope * along / A2 + (vertex.b + vertex.e * slope) * a_bar;
      const Vec3   t_bar = vertex.b / A2 * r_bar + 2. / A2 * e_bar * vertex.t;
      return {in_free_directions(t_bar, fixed), -2. / vertex.A * (vertex.b / A2 * along + vertex.e * e_bar)};
    }

    /// Pull-back of  s = (X_1 - X_0) x (X_2 - X_0) / 2.
    void reverse_area_vector(const std::array<NodeIndex, 3> &nodes,
                             const NodalVectors<double>     &X,
                             const Vec3                     &s_bar,
                             NodalVectors<double>           &X_bar)
    {
      const Vec3 a_bar = 0.5 * cross(X[nodes[2]] - X[nodes[0]], s_bar);
      const Vec3 b_bar = 0.5 * cross(s_bar, X[nodes[1]] - X[nodes[0]]);
      X_bar[nodes[1]] += a_bar;
      X_bar[nodes[2]] += b_bar;
      X_bar[nodes[0]] -= a_bar + b_bar;
    }
  } // namespace

  template <typename Number>
  NodalVectors<Number> vertex_velocities(const VertexMotionInput<Number> &in)
  {
    check_sizes(in);
    const auto           vertices = vertices_of_surface(in, faces_of_surface(in));
    NodalVectors<Number> w(in.V.begin(), in.V.begin() + in.mesh.n_nodes());
    for (NodeIndex k = 0; k < w.size(); ++k)
      if (in.topology.is_on_surface(k))
        w[k] += vertices[k].r() * vertices[k].z(in.freedom[k]);
    return w;
  }

  template NodalVectors<double> vertex_velocities(const VertexMotionInput<double> &);
  template NodalVectors<Dual>   vertex_velocities(const VertexMotionInput<Dual> &);

  void reverse_vertex_velocities(const VertexMotionInput<double> &in,
                                 const NodalVectors<double>      &w_bar,
                                 VertexMotionBar                 &bar)
  {
    check_sizes(in);
    AssertDimension(w_bar.size(), in.mesh.n_nodes());
    AssertDimension(bar.X.size(), in.X.size());
    AssertDimension(bar.V.size(), in.V.size());
    AssertDimension(bar.freedom.size(), in.freedom.size());
    const auto         faces    = faces_of_surface(in);
    const auto         vertices = vertices_of_surface(in, faces);
    const unsigned int n        = in.mesh.n_nodes();

    std::vector<double> free_bar(n, 0.), held_bar(n, 0.), u_bar(n, 0.), D_bar;
    for (NodeIndex k = 0; k < n; ++k)
    {
      bar.V[k] += w_bar[k];
      if (!in.topology.is_on_surface(k))
        continue;
      const double along = vertices[k].r() * w_bar[k];
      free_bar[k]        = in.freedom[k] * along;
      held_bar[k]        = along;
      bar.freedom[k] += vertices[k].free * along;
    }
    for (const auto &face : faces)
      D_bar.push_back(reverse_sharing(face, vertices, free_bar, held_bar, u_bar));

    std::vector<NormalBar> normal_bar(n);
    for (NodeIndex k = 0; k < n; ++k)
      if (in.topology.is_on_surface(k))
      {
        bar.freedom[k] += vertices[k].e * vertices[k].b * u_bar[k];
        normal_bar[k] = reverse_normal(vertices[k],
                                       in.topology.fixed_directions[k],
                                       vertices[k].z(in.freedom[k]) * w_bar[k],
                                       in.freedom[k] * u_bar[k]);
      }
    for (std::size_t f = 0; f < faces.size(); ++f)
    {
      const auto &face       = faces[f];
      const Vec3  defect_bar = D_bar[f] / 3. * face.s;
      const Vec3  direction  = face.s / face.s.norm();
      Vec3        s_bar      = D_bar[f] * face.defect;
      for (unsigned int i = 0; i < 3; ++i)
      {
        const NormalBar &normal = normal_bar[face.nodes[i]];
        s_bar += (normal.N + normal.A * direction) / 3.;
        bar.V[face.middles[i]] += defect_bar;
        bar.V[face.nodes[i]] -= defect_bar;
      }
      reverse_area_vector(face.nodes, in.X, s_bar, bar.X);
    }
  }
} // namespace retroforge
