// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Derivatives of distance and normal with the feature frozen, on faces, edges and vertices of a bumpy closed
// surface and on the rim of an open one, for points near and far, outside and inside, and 1e-7 from the edge.
// Proved: the reverse agrees with forward differentiation in X, displacement and all vertices; the Taylor
// remainder is of second order; on an edge, where (p-X)/|p-X| has no value, both stay finite and
// |d delta/dX| < 1.3, |dn/dX| <= 1/r.

#include <retroforge/core/dual.h>
#include <retroforge/geometry/feature_projection.h>
#include <retroforge/geometry/vector_algebra.h>

#include "../element/element_test_tools.h"
#include "geometry_test_tools.h"

using namespace retroforge;

struct Sample
{
  DieFeature feature;
  Vec3       X, displacement;
};

Vector3<Dual> with_direction(const Vec3 &x, const Vec3 &x_dot)
{
  Vector3<Dual> d;
  for (unsigned int i = 0; i < 3; ++i)
    d[i] = Dual(1, 0, x[i]), d[i].fastAccessDx(0) = x_dot[i];
  return d;
}

/// Which inputs a direction moves.
struct Moves
{
  bool X, displacement, vertices;
};

/// <bar, A x> by forward differentiation against <A^T bar, x>, relative to the products of the norms.
double product_error(const TriangleSurface &surface, const Sample &sample, const Moves &moves, Random &random)
{
  const Vec3 X_dot = moves.X ? random.vector() : Vec3(),
             u_dot = moves.displacement ? random.vector() : Vec3(), n_bar = random.vector();
  const double         delta_bar = random.scalar();
  NodalVectors<double> v_dot(surface.vertices().size());
  NodalVectors<Dual>   vertices;
  for (std::size_t v = 0; v < v_dot.size(); ++v)
  {
    if (moves.vertices)
      v_dot[v] = random.vector();
    vertices.push_back(with_direction(surface.vertices()[v], v_dot[v]));
  }
  const auto p       = project_on_feature(surface,
                                    vertices,
                                    sample.feature,
                                    with_direction(sample.X, X_dot),
                                    with_direction(sample.displacement, u_dot));
  double     forward = delta_bar * p.delta.dx(0);
  for (unsigned int i = 0; i < 3; ++i)
    forward += n_bar[i] * p.n[i].dx(0);
  Vec3                 X_bar, u_bar;
  NodalVectors<double> v_bar(v_dot.size());
  reverse_project_on_feature(
    surface, sample.feature, sample.X, sample.displacement, delta_bar, n_bar, X_bar, u_bar, &v_bar);
  const double backward = X_bar * X_dot + u_bar * u_dot + dot(v_bar, v_dot);
  const double size     = X_bar.norm() * X_dot.norm() + u_bar.norm() * u_dot.norm() +
                      std::sqrt(dot(v_bar, v_bar) * dot(v_dot, v_dot));
  return std::isfinite(forward) ? std::abs(forward - backward) / size : 1e300;
}

/// log2 of the ratio of Taylor remainders at steps h and h/2, in all inputs at once.
double taylor_order(const TriangleSurface &surface, const Sample &sample, const double h, Random &random)
{
  const Vec3           X_dot = random.vector(), u_dot = random.vector(), n_bar = random.vector();
  const double         delta_bar = random.scalar();
  NodalVectors<double> v_dot(surface.vertices().size());
  for (Vec3 &v : v_dot)
    v = random.vector();
  const auto value = [&](const double t) {
    NodalVectors<double> vertices = surface.vertices();
    for (std::size_t v = 0; v < v_dot.size(); ++v)
      vertices[v] += t * v_dot[v];
    const auto p = project_on_feature(
      surface, vertices, sample.feature, Vec3(sample.X + t * X_dot), Vec3(sample.displacement + t * u_dot));
    return delta_bar * p.delta + n_bar * p.n;
  };
  Vec3                 X_bar, u_bar;
  NodalVectors<double> v_bar(v_dot.size());
  reverse_project_on_feature(
    surface, sample.feature, sample.X, sample.displacement, delta_bar, n_bar, X_bar, u_bar, &v_bar);
  const double slope     = X_bar * X_dot + u_bar * u_dot + dot(v_bar, v_dot);
  const auto   remainder = [&](const double t) { return std::abs(value(t) - value(0.) - t * slope); };
  return std::log2(remainder(h) / remainder(0.5 * h));
}

/// |d delta/dX|, and |d(n·a)/dX| times the rounding for a unit vector a.
std::pair<double, double> slopes(const TriangleSurface &surface, const Sample &sample, Random &random)
{
  Vec3 of_delta, of_n, a = random.vector(), u;
  a /= a.norm();
  reverse_project_on_feature(surface, sample.feature, sample.X, sample.displacement, 1., Vec3(), of_delta, u);
  reverse_project_on_feature(surface, sample.feature, sample.X, sample.displacement, 0., a, of_n, u);
  return {of_delta.norm(), of_n.norm() * surface.edge_radius()};
}

/// Points whose closest feature is of each kind: by searching around the surface.
std::map<std::string, std::vector<Sample>> samples(const TriangleSurface &surface, const double offset)
{
  Random                                     random;
  const ClosestFeature                       closest(surface);
  std::map<std::string, std::vector<Sample>> found;
  for (unsigned int i = 0; i < 4000; ++i)
  {
    const Triangle &t = surface.triangles()[i % surface.n_facets()];
    const auto     &v = surface.vertices();
    const double    s = 0.5 + 0.5 * random.scalar();
    Vec3            x;
    switch (i / surface.n_facets() % 3)
    {
      case 0:
        x = (v[t[0]] + v[t[1]] + v[t[2]]) / 3.;
        break;
      case 1:
        x = s * v[t[0]] + (1. - s) * v[t[1]];
        break;
      default:
        x = v[t[2]];
    }
    x += offset * random.vector();
    const DieFeature feature = closest(x);
    if (!feature.found())
      continue;
    const auto delta = project_on_feature(surface, v, feature, x, Vec3()).delta;
    const Vec3 u     = random.vector();
    found[std::string(delta < 0. ? "inside " : "outside ") + (is_rim(surface, feature) ? "rim " : "") +
          (feature.kind == 0  ? "face"
           : feature.kind < 4 ? "edge"
                              : "vertex")]
      .push_back({feature, x + u, u});
  }
  return found;
}

double largest = 0.;

void check(const std::string &name, const TriangleSurface &surface, const double offset)
{
  Random random;
  std::cout << name << ", points " << offset << " away\n";
  for (const auto &[kind, list] : samples(surface, offset))
  {
    double              error[4] = {0., 0., 0., 0.}, steepest[2] = {0., 0.};
    std::vector<double> orders;
    for (const Sample &sample : list)
    {
      const Moves moves[] = {
        {true, false, false}, {false, true, false}, {false, false, true}, {true, true, true}};
      for (unsigned int m = 0; m < 4; ++m)
        error[m] = std::max(error[m], product_error(surface, sample, moves[m], random));
      const auto [of_delta, of_n] = slopes(surface, sample, random);
      steepest[0]                 = std::max(steepest[0], of_delta);
      steepest[1]                 = std::max(steepest[1], of_n);
      orders.push_back(taylor_order(surface, sample, offset > 1e-3 ? 2e-6 * offset : 1e-7, random));
    }
    std::sort(orders.begin(), orders.end());
    std::cout << "  " << kind << ": " << (list.size() > 20 ? "many" : "few");
    // Within the radius of an edge d and r N may nearly cancel; nearer still, X - displacement has lost digits of the
    // offset.
    const double bar = offset < 1e-6 ? 1e-12 : offset < 1e-2 ? 4e-13 : 1e-13;
    for (const double e : error)
      std::cout << " " << yes(e < bar);
    if (list.size() > 20)
      std::printf(", Taylor order, median %.1f", orders[orders.size() / 2]);
    std::printf(", bounded %s %s\n", yes(steepest[0] < 1.3), yes(steepest[1] < 1.001));
    std::fflush(stdout);
    largest = std::max({largest, error[0], error[1], error[2], error[3]});
  }
}

int main()
{
  const TriangleSurface bumpy = bumpy_sphere(2), open = sheet(5, [](double x, double y) {
                                                   return 0.2 * std::sin(5. * x) * std::cos(4. * y);
                                                 });
  for (const double offset : {0.1, 1e-3, 1e-7})
  {
    check("bumpy sphere", bumpy, offset);
    check("open sheet", open, offset);
  }
  std::cout << "FIGURE die_projection_error " << largest << std::endl;
}
