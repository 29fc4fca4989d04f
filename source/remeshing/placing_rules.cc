// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/remeshing/placing_rules.h>

namespace retroforge
{
  namespace
  {
    template <typename Number>
    Vector3<Number> constant(const Vec3 &v)
    {
      Vector3<Number> c;
      for (unsigned int i = 0; i < 3; ++i)
        c[i] = Number(v[i]);
      return c;
    }

    template <typename Number>
    Vector3<Number> times(const Number &s, const Vec3 &v)
    {
      Vector3<Number> product;
      for (unsigned int i = 0; i < 3; ++i)
        product[i] = s * v[i];
      return product;
    }

    template <typename Number>
    Vector3<Number> in_first_component(const Number &s)
    {
      Vector3<Number> v;
      v[0] = s;
      return v;
    }

    Vec3 vector_at(const double *numbers)
    {
      return Vec3({numbers[0], numbers[1], numbers[2]});
    }

    template <typename Number>
    Number dot(const Vector3<Number> &a, const Vec3 &b)
    {
      return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }

    template <typename Number>
    Vector3<Number> sum(const PlacedBy &by, const std::vector<Vector3<Number>> &x)
    {
      Vector3<Number> total;
      for (std::size_t i = 0; i < x.size(); ++i)
        total += x[i] * Number(by.numbers[i]);
      if (by.n_numbers > x.size())
        total += constant<Number>(vector_at(by.numbers + x.size()));
      return total;
    }

    template <typename Number>
    Vector3<Number> normal(const PlacedBy &by, const std::vector<Vector3<Number>> &x)
    {
      Vector3<Number> n;
      for (std::size_t i = 1; i < x.size(); i += 2)
      {
        const Vector3<Number> u = x[i] - x[0], v = x[i + 1] - x[0];
        n += cross(u, v) * Number(1. / Number(Number(u * u) * Number(v * v)));
      }
      for (unsigned int i = 0; i < by.n_numbers; i += 3)
        n -= times<Number>(dot(n, vector_at(by.numbers + i)), vector_at(by.numbers + i));
      return unit(n);
    }

    template <typename Number>
    Vector3<Number>
    middle_tangent(const Vector3<Number> &before, const Vector3<Number> &x, const Vector3<Number> &after)
    {
      const Vector3<Number> u = x - before, v = after - x;
      const Number          a = length(u), b = length(v);
      return unit(Vector3<Number>(u * Number(b / a) + v * Number(a / b)));
    }

    template <typename Number>
    Vector3<Number> end_tangent(const Vector3<Number> &chord, const Vector3<Number> &t)
    {
      const Vector3<Number> e = unit(chord);
      return unit(Vector3<Number>(e * Number(2. * Number(e * t)) - t));
    }

    /// Adds half of the Phong tessellation to a point sum_i l_i x_i.
    template <typename Number, std::size_t n>
    Vector3<Number>
    lifted(const std::array<Number, n> &l, const Vector3<Number> *x, const Vector3<Number> *normals)
    {
      Vector3<Number> p;
      for (std::size_t i = 0; i < n; ++i)
        p += x[i] * l[i];
      Vector3<Number> q = p;
      for (std::size_t i = 0; i < n; ++i)
        q += normals[i] * Number(0.5 * l[i] * Number(Vector3<Number>(x[i] - p) * normals[i]));
      return q;
    }

    template <typename Number>
    Vector3<Number> on_face(const std::vector<Vector3<Number>> &x)
    {
      const Vector3<Number> u = x[2] - x[1], v = x[3] - x[1], w = x[0] - x[1], n = cross(u, v);
      const Number          square = n * n;
      const Number          l1 = Number(cross(w, v) * n) / square, l2 = Number(cross(u, w) * n) / square;
      return lifted(std::array<Number, 3>{{1. - l1 - l2, l1, l2}}, &x[1], &x[4]);
    }

    template <typename Number>
    std::array<Number, 2>
    on_segment(const Vector3<Number> &x, const Vector3<Number> &a, const Vector3<Number> &b)
    {
      const Vector3<Number> e = b - a;
      const Number          t = Number(Vector3<Number>(x - a) * e) / Number(e * e);
      return {{1. - t, t}};
    }

    template <typename Number>
    Vector3<Number> on_ridge(const std::vector<Vector3<Number>> &x)
    {
      const std::array<Number, 2> l = on_segment(x[0], x[1], x[2]);
      const Vector3<Number>       p = x[1] * l[0] + x[2] * l[1];
      Vector3<Number>             q = p;
      for (unsigned int end = 0; end < 2; ++end)
      {
        const Vector3<Number> &tangent = x[3 + end], to_end = x[1 + end] - p;
        q += Vector3<Number>(to_end - tangent * Number(to_end * tangent)) * Number(0.5 * l[end]);
      }
      return q;
    }

    // As snap_to_planes(), which repeats it for the rounding.
    template <typename Number>
    Vector3<Number> snap(const Vector3<Number> &x, const Plane *one, const Plane *other)
    {
      const auto away = [&](const Plane &plane) {
        Number d(0.);
        for (unsigned int i = 0; i < 3; ++i)
          d += (x[i] - plane.point[i]) * plane.normal[i];
        return d;
      };
      if (!other)
        return x - times<Number>(away(*one), one->normal);
      const Number d = away(*one), e = away(*other);
      const double c = one->normal * other->normal, s = 1. / (1. - c * c);
      return x - times<Number>(Number((d - e * c) * s), one->normal) -
             times<Number>(Number((e - d * c) * s), other->normal);
    }

    template <typename Number>
    Number size(const PlacedBy &by, const std::vector<Vector3<Number>> &x)
    {
      Number total(0.);
      double count = 0.;
      for (std::size_t i = 1; i < x.size(); ++i)
      {
        total += length(Vector3<Number>(x[i] - x[0])) * by.numbers[i - 1];
        count += by.numbers[i - 1];
      }
      return total / count;
    }

    template <typename Number>
    Vector3<Number> area_around(const std::vector<Vector3<Number>> &x, const unsigned int n)
    {
      Vector3<Number> area;
      for (unsigned int i = 0; i < n; i += 2)
        area += cross(x[i], x[i + 1]);
      return area;
    }

    template <typename Number>
    Vector3<Number> outward(const PlacedBy &by, const std::vector<Vector3<Number>> &x)
    {
      const unsigned int           n_around = by.arguments[by.n_arguments - 1];
      std::vector<Vector3<Number>> across;
      const auto                   along = [&](Vector3<Number> v) {
        for (const Vector3<Number> &n : across)
          v -= n * Number(v * n);
        return v;
      };
      for (unsigned int i = 0; i < by.n_numbers; i += 3)
        across.push_back(unit(along(constant<Number>(vector_at(by.numbers + i)))));
      for (unsigned int i = n_around; i < x.size(); i += 3)
        across.push_back(
          unit(along(unit(cross(Vector3<Number>(x[i + 1] - x[i]), Vector3<Number>(x[i + 2] - x[i]))))));
      return along(unit(area_around(x, n_around)));
    }

    template <typename Number>
    Vector3<Number> step_on_surface(const PlacedBy &by, const std::vector<Vector3<Number>> &x)
    {
      const Vector3<Number> n = unit(x[2]);
      Vec3                  axis;
      axis[by.arguments[3]]   = 1.;
      const Vector3<Number> u = unit(cross(n, constant<Number>(axis))), v = unit(cross(n, u));
      return x[0] + u * Number(x[1][0] * by.numbers[0]) + v * Number(x[1][0] * by.numbers[1]);
    }
  } // namespace

  unsigned int PlacedBy::n_vectors() const
  {
    switch (rule)
    {
      case PlacingRule::push_out:
      case PlacingRule::snap:
        return 1;
      case PlacingRule::step_on_surface:
        return 3;
      case PlacingRule::outward:
        return n_arguments > 0 ? n_arguments - 1 : 0;
      default:
        return n_arguments;
    }
  }

  bool PlacedBy::is_sound() const
  {
    const auto has = [this](const unsigned int arguments, const unsigned int numbers) {
      return n_arguments == arguments && n_numbers == numbers;
    };
    switch (rule)
    {
      case PlacingRule::sum:
        return n_arguments > 0 && (n_numbers == n_arguments || n_numbers == n_arguments + 3);
      case PlacingRule::constant:
        return has(0, 3);
      case PlacingRule::normal:
        return n_arguments >= 3 && n_arguments % 2 == 1 && n_numbers % 3 == 0;
      case PlacingRule::middle_tangent:
      case PlacingRule::end_tangent:
        return has(3, 0);
      case PlacingRule::chord:
        return has(2, 0);
      case PlacingRule::on_face:
        return has(7, 0);
      case PlacingRule::on_face_edge:
      case PlacingRule::on_ridge:
        return has(5, 0);
      case PlacingRule::push_out:
        return has(4, 0);
      case PlacingRule::snap:
        return has(2, 0) || has(3, 0);
      case PlacingRule::size:
        return n_arguments > 1 && n_numbers == n_arguments - 1;
      case PlacingRule::rim:
        return n_arguments > 0 && n_arguments % 2 == 0 && n_numbers == 0;
      case PlacingRule::step_inside:
        return has(2, 3);
      case PlacingRule::step_on_surface:
        return has(4, 2) && arguments[3] < 3;
      case PlacingRule::step_on_ridge:
        return has(4, 1);
      case PlacingRule::distance:
        return n_arguments % 3 == 0 && n_numbers == 1;
      case PlacingRule::outward:
        return n_arguments > 0 && arguments[n_arguments - 1] % 2 == 0 && arguments[n_arguments - 1] > 0 &&
               arguments[n_arguments - 1] < n_arguments &&
               (n_arguments - 1 - arguments[n_arguments - 1]) % 3 == 0 && n_numbers % 3 == 0;
      case PlacingRule::shift:
        return has(3, 0);
      default:
        return false;
    }
  }

  template <typename Number>
  Vector3<Number>
  placed(const PlacedBy &by, const std::vector<Vector3<Number>> &x, const std::vector<Plane> &planes)
  {
    switch (by.rule)
    {
      case PlacingRule::sum:
        return sum(by, x);
      case PlacingRule::constant:
        return constant<Number>(vector_at(by.numbers));
      case PlacingRule::normal:
        return normal(by, x);
      case PlacingRule::middle_tangent:
        return middle_tangent(x[0], x[1], x[2]);
      case PlacingRule::end_tangent:
        return end_tangent(Vector3<Number>(x[1] - x[0]), x[2]);
      case PlacingRule::chord:
        return unit(Vector3<Number>(x[1] - x[0]));
      case PlacingRule::on_face:
        return on_face(x);
      case PlacingRule::on_face_edge:
        return lifted(on_segment(x[0], x[1], x[2]), &x[1], &x[3]);
      case PlacingRule::on_ridge:
        return on_ridge(x);
      case PlacingRule::snap:
        return snap(x[0], &planes[by.arguments[1]], by.n_arguments > 2 ? &planes[by.arguments[2]] : nullptr);
      case PlacingRule::size:
        return in_first_component(size(by, x));
      case PlacingRule::rim:
        return area_around(x, x.size());
      case PlacingRule::outward:
        return outward(by, x);
      case PlacingRule::shift:
        return x[0] + x[2] * x[1][0];
      case PlacingRule::step_inside:
        return x[0] + times<Number>(x[1][0], vector_at(by.numbers));
      case PlacingRule::step_on_surface:
        return step_on_surface(by, x);
      case PlacingRule::step_on_ridge:
        return x[0] + unit(Vector3<Number>(x[3] - x[2])) * Number(x[1][0] * by.numbers[0]);
      default:
        AssertThrow(false, dealii::ExcMessage("this rule needs dies or meshes"));
        return {};
    }
  }

  template Vec3 placed(const PlacedBy &, const std::vector<Vec3> &, const std::vector<Plane> &);
  template Vector3<Dual>
  placed(const PlacedBy &, const std::vector<Vector3<Dual>> &, const std::vector<Plane> &);
  template Vector3<Gradient3>
  placed(const PlacedBy &, const std::vector<Vector3<Gradient3>> &, const std::vector<Plane> &);
} // namespace retroforge
