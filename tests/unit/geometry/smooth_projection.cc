// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// A triangulated die stands for a smooth one. Proved, with a unit sphere of finer and finer facets and points
// up to 0.3 from it on both sides: distance and normal converge to |X| - 1 and X/|X| with order 2 and more,
// the derivative of the normal to the curvature, (1 - n n)/|X|, where that of facets is zero. Across the
// boundary of two facets distance and normal are continuous. On bumpy surfaces the reverse is the transpose
// of the dual numbers' derivative, in the point, the displacement and all vertices, and remainders fall with
// order 2. A flat face beside a small rounding stays flat to rounding; a cube, all of whose edges are sharp,
// is what its facets are; normals of a tripod and a bell are those of their exact shapes to a fraction of a
// degree.

#include <retroforge/core/dual.h>
#include <retroforge/geometry/die.h>
#include <retroforge/geometry/die_shapes.h>

#include "../element/element_test_tools.h"
#include "geometry_test_tools.h"

using namespace retroforge;

namespace
{
  constexpr double far = 1e3; ///< deeper than all points here

  Vector3<Dual> with_direction(const Vec3 &x, const Vec3 &x_dot)
  {
    Vector3<Dual> d;
    for (unsigned int i = 0; i < 3; ++i)
      d[i] = Dual(1, 0, x[i]), d[i].fastAccessDx(0) = x_dot[i];
    return d;
  }

  Vec3 direction(Random &random)
  {
    const Vec3 a = random.vector();
    return a / a.norm();
  }

  struct Errors
  {
    double delta = 0., n = 0., slope = 0.;
  };

  Errors sphere_errors(const unsigned int n, const bool smooth)
  {
    const Die die("sphere", sphere(n), far, {smooth, 60.});
    Random    random;
    Errors    errors;
    for (unsigned int i = 0; i < 300; ++i)
    {
      const Vec3       a      = direction(random);
      const double     radius = 1. + 0.3 * random.scalar();
      const Vec3       X = radius * a, t = cross(a, direction(random));
      const DieFeature feature = die.closest(X, Vec3());
      const auto       p       = die.project(X, Vec3(), feature);
      const auto       d = die.project<Dual>(with_direction(X, t), with_direction(Vec3(), Vec3()), feature);
      Vec3             n_dot;
      for (unsigned int k = 0; k < 3; ++k)
        n_dot[k] = d.n[k].dx(0);
      errors.delta = std::max(errors.delta, std::abs(p.delta - (radius - 1.)));
      errors.n     = std::max(errors.n, (p.n + a).norm());
      errors.slope += (n_dot + t / radius).norm() / (t / radius).norm() / 300.;
    }
    return errors;
  }

  void converge()
  {
    std::cout << "sphere\n";
    Errors before = sphere_errors(3, true);
    for (unsigned int n = 4; n < 6; ++n)
    {
      const Errors now = sphere_errors(n, true);
      std::printf("  distance of order %.0f, normal %s, its slope %s\n",
                  std::log2(before.delta / now.delta),
                  now.n < 1e-12 ? "exact" : "NOT exact",
                  now.slope < 1e-10 ? "exact" : "NOT exact");
      before = now;
    }
    std::printf("  slope of the facets' normals off the curvature: %.0f %%\n",
                100. * sphere_errors(5, false).slope);
    std::cout << "FIGURE smooth_sphere_distance_error " << before.delta << "\n"
              << "FIGURE smooth_sphere_slope_error " << before.slope << "\n";
  }

  /// Largest jump of n and delta where the feature changes along random lines, found by bisection.
  double largest_jump(const Die &die, const double offset)
  {
    Random       random;
    double       jump = 0.;
    unsigned int n    = 0;
    for (unsigned int i = 0; i < 400; ++i)
    {
      const Vec3 a   = (1. + offset * random.scalar()) * direction(random);
      const Vec3 b   = a + 0.05 * random.vector();
      double     low = 0., high = 1.;
      const auto feature = [&](const double t) { return die.closest(a + t * (b - a), Vec3()); };
      if (feature(0.) == feature(1.))
        continue;
      const DieFeature first = feature(0.);
      while (high - low > 1e-13)
        (feature(0.5 * (low + high)) == first ? low : high) = 0.5 * (low + high);
      const auto p = die.project(Vec3(a + low * (b - a)), Vec3(), first),
                 q = die.project(Vec3(a + high * (b - a)), Vec3(), feature(high));
      jump         = std::max({jump, (p.n - q.n).norm(), std::abs(p.delta - q.delta)});
      ++n;
    }
    return n > 100 ? jump : 1e300;
  }

  double product_error(const Die &die, const Vec3 &X, const Vec3 &displacement, Random &random)
  {
    const DieFeature     feature = die.closest(X, displacement);
    const Vec3           X_dot = random.vector(), u_dot = random.vector(), n_bar = random.vector();
    const double         delta_bar = random.scalar();
    NodalVectors<double> v_dot;
    NodalVectors<Dual>   vertices;
    for (const Vec3 &v : die.surface()->vertices())
    {
      v_dot.push_back(random.vector());
      vertices.push_back(with_direction(v, v_dot.back()));
    }
    const DieState<Dual> state{{}, with_direction(displacement, u_dot), Dual(0.), vertices};
    const auto           p       = die.project(with_direction(X, X_dot), state, feature);
    double               forward = delta_bar * p.delta.dx(0);
    for (unsigned int i = 0; i < 3; ++i)
      forward += n_bar[i] * p.n[i].dx(0);
    Vec3                 X_bar, u_bar;
    NodalVectors<double> v_bar(v_dot.size());
    die.reverse_project(X, displacement, feature, delta_bar, n_bar, X_bar, u_bar, &v_bar);
    double backward = X_bar * X_dot + u_bar * u_dot, size = X_bar.norm() + u_bar.norm();
    for (std::size_t v = 0; v < v_dot.size(); ++v)
    {
      backward += v_bar[v] * v_dot[v];
      size += v_bar[v].norm();
    }
    return std::abs(forward - backward) / size;
  }

  double taylor_order(const Die &die, const Vec3 &X, Random &random)
  {
    const DieFeature     feature = die.closest(X, Vec3());
    const Vec3           X_dot = random.vector(), n_bar = random.vector();
    const double         delta_bar = random.scalar();
    NodalVectors<double> v_dot;
    for (std::size_t v = 0; v < die.surface()->vertices().size(); ++v)
      v_dot.push_back(random.vector());
    const auto value = [&](const double t) {
      NodalVectors<double> vertices = die.surface()->vertices();
      for (std::size_t v = 0; v < v_dot.size(); ++v)
        vertices[v] += t * v_dot[v];
      const auto p = die.project(Vec3(X + t * X_dot), DieState<double>{{}, {}, 0., vertices}, feature);
      return delta_bar * p.delta + n_bar * p.n;
    };
    Vec3                 X_bar, u_bar;
    NodalVectors<double> v_bar(v_dot.size());
    die.reverse_project(X, Vec3(), feature, delta_bar, n_bar, X_bar, u_bar, &v_bar);
    double slope = X_bar * X_dot;
    for (std::size_t v = 0; v < v_dot.size(); ++v)
      slope += v_bar[v] * v_dot[v];
    const auto remainder = [&](const double t) { return std::abs(value(t) - value(0.) - t * slope); };
    return std::log2(remainder(1e-4) / remainder(5e-5));
  }

  void differentiate(const std::string &name, const Die &die, const double offset)
  {
    Random              random;
    std::vector<double> orders;
    double              error  = 0.;
    unsigned int        n_face = 0;
    for (unsigned int i = 0; i < 300; ++i)
    {
      const auto     &v = die.surface()->vertices();
      const Triangle &t = die.surface()->triangles()[i % die.n_facets()];
      const Vec3      X = (v[t[0]] + v[t[1]] + v[t[2]]) / 3. + offset * random.vector(), u = random.vector();
      if (!die.closest(X, Vec3()).found())
        continue;
      n_face += die.closest(X, Vec3()).kind == 0;
      error = std::max(error, product_error(die, X + u, u, random));
      orders.push_back(taylor_order(die, X, random));
    }
    std::sort(orders.begin(), orders.end());
    std::printf("%s: on faces %s, transpose %s, Taylor order, median %.1f\n",
                name.c_str(),
                yes(n_face > 150),
                yes(error < 1e-12),
                orders[orders.size() / 2]);
    std::cout << "FIGURE smooth_projection_error " << error << "\n";
  }

  /// A flat face for x < 0, a rounding of radius r behind it, in strips along y.
  TriangleSurface rounded_edge(const double r)
  {
    std::vector<std::pair<double, double>> section = {{-1., 0.}, {-0.5, 0.}, {0., 0.}};
    for (unsigned int i = 1; i <= 4; ++i)
      section.emplace_back(r * std::sin(i * M_PI / 8.), r * (std::cos(i * M_PI / 8.) - 1.));
    section.emplace_back(r, -1.);
    NodalVectors<double>  x;
    std::vector<Triangle> t;
    constexpr unsigned    m = 10;
    for (const auto &[a, z] : section)
      for (unsigned int j = 0; j <= m; ++j)
        x.push_back(Vec3({a, -1. + 2. * j / m, z}));
    for (unsigned int i = 0; i + 1 < section.size(); ++i)
      for (unsigned int j = 0; j < m; ++j)
      {
        const unsigned int a = i * (m + 1) + j, b = a + m + 1;
        t.insert(t.end(), {{{a, b, b + 1}}, {{a, b + 1, a + 1}}});
      }
    return TriangleSurface("rounded edge", x, t);
  }

  void stay_flat()
  {
    const double r = 0.1;
    const Die    die("edge", rounded_edge(r), far);
    Random       random;
    double       flat = 0., round = 0.;
    for (unsigned int i = 0; i < 200; ++i)
    {
      const double y = 0.8 * random.scalar(), height = 0.05 * random.scalar();
      const Vec3   X({-0.5 + 0.45 * random.scalar(), y, height});
      const auto   p = die.project(X, Vec3(), die.closest(X, Vec3()));
      flat           = std::max({flat, std::abs(p.delta - height), (p.n + Vec3({0., 0., 1.})).norm()});
      const double a = M_PI / 4. * (1. + 0.95 * random.scalar());
      const Vec3   m({std::sin(a), 0., std::cos(a)}), Y = Vec3({0., y, -r}) + (r + height) * m;
      const auto   q = die.project(Y, Vec3(), die.closest(Y, Vec3()));
      round          = std::max(round, (q.n + m).norm());
    }
    std::cout << "flat face beside a rounding of 4 facets: flat " << yes(flat < 1e-13)
              << ", normals of the rounding within 0.02 " << yes(round < 0.02) << "\n";
    std::cout << "FIGURE rounding_normal_error " << round << "\n";
  }

  void stay_sharp()
  {
    const Die smooth("cube", cube(), far), facets("cube", cube(), far, {false, 0.});
    Random    random;
    double    difference = 0.;
    for (unsigned int i = 0; i < 500; ++i)
    {
      const Vec3 X = Vec3({0.5, 0.5, 0.5}) + 0.8 * random.vector();
      const auto p = smooth.project(X, Vec3(), smooth.closest(X, Vec3())),
                 q = facets.project(X, Vec3(), facets.closest(X, Vec3()));
      difference   = std::max({difference, std::abs(p.delta - q.delta), (p.n - q.n).norm()});
    }
    std::cout << "cube: as its facets " << yes(difference < 1e-12) << "\n";
  }

  /// Normals of a bell at its vertices against those of its section, a body of revolution.
  void know_shapes()
  {
    const BellShape<double> bell;
    const auto              mesh = shape_mesh("bell", bell, 0.05);
    const TriangleSurface   surface("bell", mesh.vertices, mesh.triangles);
    const CornerNormals     normals(surface, 40.);
    const double draft = bell.profile.draft * M_PI / 180., turn = M_PI / 2. - draft, e = bell.profile.edge,
                 f = bell.profile.fillet, tangent = std::tan(0.5 * turn);
    const double reach_out = e * tangent, reach_in = bell.profile.depth * std::tan(draft) + f * tangent;
    double       largest = 0.;
    for (unsigned int facet = 0; facet < surface.n_facets(); ++facet)
      for (unsigned int c = 0; c < 3; ++c)
      {
        const Vec3  &x = surface.vertices()[surface.triangles()[facet][c]];
        const double r = std::hypot(x[0], x[1]), o = bell.mouth - r;
        if (r < 1e-9 || r > bell.mouth + reach_out + 1e-6)
          continue;
        // Slope of the section against the z axis: 0 on floor and face, `turn` along the wall.
        const double from_floor = std::asin(std::min(1., std::max(0., (reach_in - o) / f))),
                     from_face  = std::asin(std::min(1., std::max(0., (o + reach_out) / e)));
        const double a          = std::min({from_floor, from_face, turn});
        const Vec3   m({-std::sin(a) * x[0] / r, -std::sin(a) * x[1] / r, std::cos(a)});
        largest = std::max(largest, (normals[normals.of_corner(facet, c)] - m).norm() * 180. / M_PI);
      }
    std::printf("bell: corner normals are the exact ones %s\n", yes(largest < 1e-9));
    std::cout << "FIGURE bell_normal_error " << largest << "\n";
  }
} // namespace

int main()
{
  converge();
  const Die smooth("sphere", sphere(4), far), bumpy("bumpy", bumpy_sphere(4), far, {true, 180.});
  std::cout << "continuous across facets: " << yes(largest_jump(smooth, 0.2) < 1e-10) << "\n";
  differentiate("sphere", smooth, 0.02);
  differentiate("bumpy sphere", bumpy, 0.02);
  differentiate(
    "open sheet",
    Die("sheet", sheet(9, [](double x, double y) { return 0.1 * std::sin(3. * x) * std::cos(2. * y); }), far),
    0.05);
  stay_flat();
  stay_sharp();
  know_shapes();
}
