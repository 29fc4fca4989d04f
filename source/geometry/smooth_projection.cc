// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/dual.h>
#include <retroforge/geometry/smooth_projection.h>

#include <deal.II/base/tensor.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    using Matrix3 = dealii::Tensor<2, 3>;

    /// Corners and normals of one facet.
    template <typename Number>
    struct Facet
    {
      std::array<Vector3<Number>, 3> x, n;
    };

    template <typename Number, typename VertexNumber>
    Facet<Number> make_facet(const TriangleSurface            &surface,
                             const CornerNormals              &normals,
                             const NodalVectors<VertexNumber> *vertices,
                             const unsigned int                f)
    {
      Facet<Number> facet;
      for (unsigned int c = 0; c < 3; ++c)
      {
        const unsigned int vertex = surface.triangles()[f][c], normal = normals.of_corner(f, c);
        if (vertices)
          facet.n[c] = normals.template normal<Number>(surface, *vertices, normal);
        for (unsigned int i = 0; i < 3; ++i)
        {
          facet.x[c][i] = vertices ? Number((*vertices)[vertex][i]) : Number(surface.vertices()[vertex][i]);
          if (!vertices)
            facet.n[c][i] = Number(normals[normal][i]);
        }
      }
      return facet;
    }

    template <typename Number>
    Facet<double> values_of(const Facet<Number> &facet)
    {
      Facet<double> values;
      for (unsigned int c = 0; c < 3; ++c)
        for (unsigned int i = 0; i < 3; ++i)
        {
          values.x[c][i] = value_of(facet.x[c][i]);
          values.n[c][i] = value_of(facet.n[c][i]);
        }
      return values;
    }

    /// l_1, l_2 and d of the foot.
    template <typename Number>
    struct Foot
    {
      std::array<Number, 3> l;
      Number                d;
    };

    template <typename Number>
    Vector3<Number> interpolated(const std::array<Vector3<Number>, 3> &at_corners,
                                 const std::array<Number, 3>          &l)
    {
      return at_corners[0] * l[0] + at_corners[1] * l[1] + at_corners[2] * l[2];
    }

    /// sum_a l_a x_a + d N - X.
    template <typename Number>
    Vector3<Number> mismatch(const Facet<Number> &facet, const Foot<Number> &foot, const Vector3<Number> &X)
    {
      return interpolated(facet.x, foot.l) + interpolated(facet.n, foot.l) * foot.d - X;
    }

    /// Derivative of the mismatch in (l_1, l_2, d), one column each.
    Matrix3 jacobian(const Facet<double> &facet, const Foot<double> &foot)
    {
      Matrix3    J;
      const Vec3 N = interpolated(facet.n, foot.l);
      for (unsigned int i = 0; i < 3; ++i)
      {
        for (unsigned int a = 1; a < 3; ++a)
          J[i][a - 1] = facet.x[a][i] - facet.x[0][i] + foot.d * (facet.n[a][i] - facet.n[0][i]);
        J[i][2] = N[i];
      }
      return J;
    }

    template <typename Number>
    void move(Foot<Number> &foot, const Number &l_1, const Number &l_2, const Number &d)
    {
      foot.l[0] += -l_1 - l_2;
      foot.l[1] += l_1;
      foot.l[2] += l_2;
      foot.d += d;
    }

    /// Newton's method from the facet's plane. @return whether X is nearer to the surface than its centre of
    /// curvature, where normals meet, and the foot was found
    bool find_foot(const Facet<double> &facet, const Vec3 &X, Foot<double> &foot)
    {
      const Vec3   a = facet.x[1] - facet.x[0], b = facet.x[2] - facet.x[0], v = cross(a, b);
      const double v2 = v * v, size = std::sqrt(std::sqrt(v2));
      const Vec3   x  = X - facet.x[0];
      const double l1 = v * cross(x, b) / v2, l2 = v * cross(a, x) / v2;
      foot                        = {{{1. - l1 - l2, l1, l2}}, x * v / std::sqrt(v2)};
      constexpr unsigned int most = 20;
      for (unsigned int i = 0; i < most; ++i)
      {
        const Matrix3 J      = jacobian(facet, foot);
        const double  volume = determinant(J);
        if (!(volume > 0.02 * std::sqrt(v2)))
          return false;
        const Vec3 step = -(invert(J) * mismatch(facet, foot, X));
        move(foot, step[0], step[1], step[2]);
        const double change = std::max({std::abs(step[0]), std::abs(step[1]), std::abs(step[2]) / size});
        if (!(change < 1e6))
          return false;
        if (change < 1e-8) // the error is of its square
          return true;
      }
      return false;
    }

    /// p and N of a foot.
    template <typename Number>
    std::pair<Vector3<Number>, Vector3<Number>> lifted(const Facet<Number> &facet, const Foot<Number> &foot)
    {
      const Vector3<Number> p0 = interpolated(facet.x, foot.l);
      Vector3<Number>       p  = p0;
      for (unsigned int a = 0; a < 3; ++a)
        p += facet.n[a] * Number(0.5 * foot.l[a] * Number((facet.x[a] - p0) * facet.n[a]));
      return {p, interpolated(facet.n, foot.l)};
    }

    DieFeature as_flat(const DieFeature &feature)
    {
      return feature.kind == 0 ? DieFeature{feature.facet, DieFeature::flat_face} : feature;
    }

    DieFeature as_face_of_facets(const DieFeature &feature)
    {
      return feature.kind == DieFeature::flat_face ? DieFeature{feature.facet, 0} : feature;
    }
  } // namespace

  DieFeature feature_of_smooth_surface(const TriangleSurface &surface,
                                       const CornerNormals   &normals,
                                       const DieFeature      &closest,
                                       const Vec3            &X)
  {
    if (closest.kind >= 4 && normals.is_on_sharp_edge(surface.triangles()[closest.facet][closest.kind - 4]))
      return closest;
    if (closest.kind > 0 && closest.kind < 4 && normals.is_sharp(closest.facet, closest.kind - 1))
      return closest;
    constexpr double       rounding = 1e-12;
    constexpr double       near     = 0.5; ///< over a sharp edge, in coordinates of the facet
    constexpr unsigned int most     = 32;
    unsigned int           facet    = closest.facet;
    for (unsigned int step = 0; step < most; ++step)
    {
      Foot<double> foot;
      if (!find_foot(make_facet<double, double>(surface, normals, nullptr, facet), X, foot))
        break;
      std::array<unsigned int, 3> corners = {{0, 1, 2}};
      std::sort(corners.begin(), corners.end(), [&](const unsigned int a, const unsigned int b) {
        return foot.l[a] != foot.l[b] ? foot.l[a] < foot.l[b] : a < b;
      });
      if (foot.l[corners[0]] >= -rounding)
        return {facet, 0};
      // Over the edge opposite of the corner with the most negative coordinate, unless it is sharp.
      unsigned int next = invalid_index;
      for (const unsigned int corner : corners)
        if (foot.l[corner] < -rounding && next == invalid_index && !normals.is_sharp(facet, (corner + 1) % 3))
          next = surface.neighbour(facet, (corner + 1) % 3).facet;
      if (next == invalid_index)
      {
        if (foot.l[corners[0]] > -near)
          return {facet, 0};
        break;
      }
      facet = next;
    }
    return as_flat(closest);
  }

  template <typename Number, typename VertexNumber>
  Projection<Number> project_smoothly(const TriangleSurface            &surface,
                                      const CornerNormals              &normals,
                                      const NodalVectors<VertexNumber> *vertices,
                                      const DieFeature                 &feature,
                                      const Vector3<Number>            &X,
                                      const Vector3<Number>            &displacement)
  {
    const auto of_facets = [&]() {
      return vertices
               ? project_on_feature(surface, *vertices, as_face_of_facets(feature), X, displacement)
               : project_on_feature(surface, surface.vertices(), as_face_of_facets(feature), X, displacement);
    };
    if (feature.kind != 0)
      return of_facets();
    const Vector3<Number> x     = X - displacement;
    const Facet<Number>   facet = make_facet<Number>(surface, normals, vertices, feature.facet);
    const Facet<double>   at    = values_of(facet);
    Vec3                  x_at;
    for (unsigned int i = 0; i < 3; ++i)
      x_at[i] = value_of(x[i]);
    Foot<double> found;
    if (!find_foot(at, x_at, found))
      return of_facets(); // a replay that went too far from what was recorded
    Foot<Number> foot{{{Number(found.l[0]), Number(found.l[1]), Number(found.l[2])}}, Number(found.d)};
    if constexpr (!std::is_same<Number, double>::value)
    {
      // One more step of Newton's method, in numbers with derivatives: exact, as the matrix is.
      const Matrix3         J = invert(jacobian(at, found));
      const Vector3<Number> r = mismatch(facet, foot, x);
      std::array<Number, 3> step;
      for (unsigned int i = 0; i < 3; ++i)
        step[i] = -(J[i][0] * r[0] + J[i][1] * r[1] + J[i][2] * r[2]);
      move(foot, step[0], step[1], step[2]);
    }
    const auto [p, N] = lifted(facet, foot);
    Projection<Number> projection;
    projection.n     = -unit(N);
    projection.delta = (p - x) * projection.n;
    return projection;
  }

  void reverse_project_smoothly(const TriangleSurface &surface,
                                const CornerNormals   &normals,
                                const DieFeature      &feature,
                                const Vec3            &X,
                                const Vec3            &displacement,
                                const double           delta_bar,
                                const Vec3            &n_bar,
                                Vec3                  &X_bar,
                                Vec3                  &displacement_bar,
                                NodalVectors<double>  *vertices_bar)
  {
    const Vec3          x     = X - displacement;
    const Facet<double> facet = make_facet<double, double>(surface, normals, nullptr, feature.facet);
    Foot<double>        foot;
    if (feature.kind != 0 || !find_foot(facet, x, foot))
    {
      reverse_project_on_feature(surface,
                                 as_face_of_facets(feature),
                                 X,
                                 displacement,
                                 delta_bar,
                                 n_bar,
                                 X_bar,
                                 displacement_bar,
                                 vertices_bar);
      return;
    }
    const auto [p, N]       = lifted(facet, foot);
    const Vec3            n = -unit(N), p0 = interpolated(facet.x, foot.l);
    const Vec3            N_bar = -reverse_unit(N, n_bar + delta_bar * (p - x)), p_bar = delta_bar * n;
    std::array<double, 3> l_bar;
    std::array<Vec3, 3>   corner_bar, normal_bar;
    Vec3                  p0_bar = p_bar;
    for (unsigned int a = 0; a < 3; ++a)
    {
      const double c = (facet.x[a] - p0) * facet.n[a], w = 0.5 * (p_bar * facet.n[a]), c_bar = foot.l[a] * w;
      l_bar[a]      = N_bar * facet.n[a] + w * c;
      corner_bar[a] = c_bar * facet.n[a];
      normal_bar[a] = foot.l[a] * N_bar + 0.5 * foot.l[a] * c * p_bar + c_bar * (facet.x[a] - p0);
      p0_bar -= c_bar * facet.n[a];
    }
    for (unsigned int a = 0; a < 3; ++a)
    {
      l_bar[a] += p0_bar * facet.x[a];
      corner_bar[a] += foot.l[a] * p0_bar;
    }
    // The coordinates solve mismatch = 0.
    const Vec3 y =
      transpose(invert(jacobian(facet, foot))) * Vec3({l_bar[1] - l_bar[0], l_bar[2] - l_bar[0], 0.});
    const Vec3 x_bar = y - p_bar;
    X_bar += x_bar;
    displacement_bar -= x_bar;
    if (!vertices_bar)
      return;
    for (unsigned int a = 0; a < 3; ++a)
    {
      (*vertices_bar)[surface.triangles()[feature.facet][a]] += corner_bar[a] - foot.l[a] * y;
      normals.reverse_normal(
        surface, normals.of_corner(feature.facet, a), normal_bar[a] - foot.l[a] * foot.d * y, *vertices_bar);
    }
  }

#define RETROFORGE_INSTANTIATE(Number, VertexNumber)                               \
  template Projection<Number> project_smoothly(const TriangleSurface &,            \
                                               const CornerNormals &,              \
                                               const NodalVectors<VertexNumber> *, \
                                               const DieFeature &,                 \
                                               const Vector3<Number> &,            \
                                               const Vector3<Number> &);
  RETROFORGE_INSTANTIATE(double, double)
  RETROFORGE_INSTANTIATE(Dual, double)
  RETROFORGE_INSTANTIATE(Dual, Dual)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
