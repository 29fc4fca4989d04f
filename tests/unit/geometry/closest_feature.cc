// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The search for the closest feature against looking at all facets: the same feature, bit for bit, on closed
// and open surfaces, for points anywhere, on vertices and on edges, with and without a limit of distance;
// where features tie, both take the one of lowest index. Signed distance against the closed form: of the cube
// exactly, of a sphere to second order in the facets' size. A displaced die finds a feature where its
// distance is within reach and depth, and nowhere else; a smooth one where that of its facets is not farther.

#include <retroforge/geometry/die.h>

#include <iostream>

#include "../element/element_test_tools.h"
#include "geometry_test_tools.h"

using namespace retroforge;

double signed_distance(const TriangleSurface &surface, const DieFeature &feature, const Vec3 &X)
{
  return project_on_feature(surface, surface.vertices(), feature, X, Vec3()).delta;
}

/// Points of all kinds around a surface of size about 1.
NodalVectors<double> points(const TriangleSurface &surface, Random &random)
{
  NodalVectors<double> X;
  for (unsigned int i = 0; i < 2000; ++i)
    X.push_back(1.7 * random.vector());
  for (unsigned int f = 0; f < surface.n_facets(); ++f)
    for (unsigned int c = 0; c < 3; ++c)
    {
      const Vec3 &a = surface.vertices()[surface.triangles()[f][c]],
                 &b = surface.vertices()[surface.triangles()[f][(c + 1) % 3]];
      X.insert(X.end(),
               {a, 0.5 * (a + b), a + 1e-7 * random.vector(), 0.3 * a + 0.7 * b + 1e-3 * random.vector()});
    }
  return X;
}

void compare(const std::string &name, const TriangleSurface &surface)
{
  Random               random;
  const ClosestFeature closest(surface);
  unsigned int         n_wrong = 0, n_far = 0, n_behind = 0, n_kind[3] = {0, 0, 0};
  const auto           X = points(surface, random);
  for (const Vec3 &x : X)
  {
    const DieFeature feature = closest(x);
    n_wrong += feature != closest_feature_of_all(surface, x, 1e300);
    n_behind += !feature.found();
    n_kind[feature.kind == 0 ? 0 : feature.kind < 4 ? 1 : 2] += feature.found();
    const DieFeature near = closest(x, 0.2);
    n_wrong += near != closest_feature_of_all(surface, x, 0.2);
    n_far += !near.found();
  }
  std::cout << name << ": " << surface.n_facets() << " facets, " << X.size() << " points, wrong " << n_wrong
            << "; faces " << n_kind[0] << ", edges " << n_kind[1] << ", vertices " << n_kind[2] << ", behind "
            << n_behind << ", not within 0.2: " << n_far << "\n";
}

void check_die(const bool smooth)
{
  const double depth = 0.15;
  const Die    die("bumpy", bumpy_sphere(3), depth, {smooth, 40.}),
    facets("bumpy", bumpy_sphere(3), depth, {false, 0.});
  const Vec3   u({0.3, -0.2, 0.1});
  Random       random;
  unsigned int n_wrong = 0, n_found = 0;
  for (unsigned int i = 0; i < 5000; ++i)
  {
    const Vec3       X        = 2. * random.vector();
    const double     distance = die.signed_distance(X, u), reach = 0.1 + 0.1 * (i % 3);
    const DieFeature feature = die.closest(X, u, reach);
    // What facets are looked at is decided by their own distance, also where they stand for a smooth surface.
    const bool is_seen = std::abs(facets.signed_distance(X, u)) <= std::max(reach, depth);
    n_found += feature.found();
    n_wrong += feature.found() != (is_seen && distance >= -depth && distance <= reach);
    n_wrong += feature.found() && die.project(X, u, feature).delta != distance;
  }
  std::cout << (smooth ? "smooth die" : "die of facets") << ", within reach and depth: some "
            << yes(n_found > 500 && n_found < 4500) << ", wrong " << n_wrong << "\n";
}

void check_cube()
{
  const TriangleSurface surface = cube();
  const ClosestFeature  closest(surface);
  Random                random;
  double                error = 0.;
  for (unsigned int i = 0; i < 5000; ++i)
  {
    const Vec3 X = 1.5 * random.vector();
    // Distance of a box: outside the norm of what sticks out, inside the largest of the coordinates' excess.
    Vec3   out;
    double inside = -1e300;
    for (unsigned int k = 0; k < 3; ++k)
    {
      const double excess = std::max(-X[k], X[k] - 1.);
      out[k]              = std::max(excess, 0.);
      inside              = std::max(inside, excess);
    }
    const double exact = inside > 0. ? out.norm() : inside;
    error              = std::max(error, std::abs(signed_distance(surface, closest(X), X) - exact));
  }
  std::cout << "cube, error of the signed distance < 0.3 rounding: "
            << yes(error < 0.3 * surface.edge_radius()) << ", of some point > 1e-9: " << yes(error > 1e-9)
            << "\n";
}

void check_sphere()
{
  std::cout << "sphere, largest error of the signed distance times 4^refinements, of the normal times "
               "2^refinements\n";
  for (unsigned int n = 2; n < 6; ++n)
  {
    const TriangleSurface surface = sphere(n);
    const ClosestFeature  closest(surface);
    Random                random;
    double                distance = 0., normal = 0.;
    for (unsigned int i = 0; i < 3000; ++i)
    {
      const Vec3 X = 1.5 * random.vector();
      if (X.norm() < 0.3)
        continue;
      const auto p = project_on_feature(surface, surface.vertices(), closest(X), X, Vec3());
      distance     = std::max(distance, std::abs(p.delta - (X.norm() - 1.)));
      normal       = std::max(normal, (p.n + X / X.norm()).norm());
    }
    std::printf("  %.2f %.2f\n", std::pow(4., n) * distance, std::pow(2., n) * normal);
  }
}

void check_rim()
{
  const TriangleSurface flat = sheet(4, [](double, double) { return 0.; });
  const ClosestFeature  closest(flat);
  std::cout << "open sheet in z = 0, |x|, |y| <= 1: distance, or behind\n";
  for (const Vec3 &X : {Vec3({0.3, 0.1, 0.2}),
                        Vec3({0.3, 0.1, -0.2}),
                        Vec3({1.3, 0.1, 0.4}),
                        Vec3({1.3, 0.1, -0.4}),
                        Vec3({1.3, 1.4, 1.2}),
                        Vec3({1. + 1e-6, 0.1, -0.2}),
                        Vec3({1., 0.1, -0.2}),
                        Vec3({1. + 1e-6, 1. + 1e-6, -0.2}),
                        Vec3({1. + 1e-3, 0.1, -0.2})})
  {
    const DieFeature feature = closest(X);
    std::printf("  (%g, %g, %g): ", X[0], X[1], X[2]);
    if (feature.found())
      std::printf("facet %u kind %u delta %.4f\n",
                  feature.facet,
                  unsigned(feature.kind),
                  signed_distance(flat, feature, X));
    else
      std::printf("behind\n");
  }
}

int main()
{
  compare("sphere", sphere(3));
  compare("bumpy sphere", bumpy_sphere(3));
  compare("cube", cube());
  compare("flat sheet", sheet(8, [](double, double) { return 0.; }));
  compare("wavy sheet",
          sheet(8, [](double x, double y) { return 0.2 * std::sin(5. * x) * std::cos(4. * y); }));
  check_die(false);
  check_die(true);
  check_cube();
  check_sphere();
  check_rim();
}
