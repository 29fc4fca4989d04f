// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Tripod and bell. Proved: what is made is an oriented surface without cracks whose only rim is that of the
// face, every facet looks up, and it equals its mirror images; distances of the facets from the smooth shape
// stay within the chord error; the cavity's volume converges to Pappus' value, for a bell by a closed form;
// vertices' derivatives in the shape's parameters agree with central differences; measures that do not fit
// are refused. Printed too: the volume between two default tripods 20 mm apart at the floors, against the
// billet of radius 20 and height 60 that they are for.

#include <retroforge/core/dual.h>
#include <retroforge/core/error.h>
#include <retroforge/geometry/closest_feature.h>
#include <retroforge/geometry/die_shapes.h>
#include <retroforge/geometry/feature_projection.h>

#include <functional>
#include <iostream>

#include "geometry_test_tools.h"

using namespace retroforge;

TriangleSurface surface(const ShapeMesh<double> &mesh)
{
  return TriangleSurface("die", mesh.vertices, mesh.triangles);
}

/// Volume between the surface and the plane z = 0.
double cavity_volume(const TriangleSurface &die)
{
  double volume = 0.;
  for (const Triangle &t : die.triangles())
  {
    const auto &x = die.vertices();
    const Vec3  v = facet_vector(x[t[0]], x[t[1]], x[t[2]]);
    volume -= 0.5 * v[2] * (x[t[0]][2] + x[t[1]][2] + x[t[2]][2]) / 3.;
  }
  return volume;
}

void check_surface(const std::string     &name,
                   const TriangleSurface &die,
                   const double           outer,
                   const unsigned int     n_mirrors)
{
  unsigned int n_down = 0, n_inner_rim = 0;
  for (const Triangle &t : die.triangles())
    n_down += !(facet_vector(die.vertices()[t[0]], die.vertices()[t[1]], die.vertices()[t[2]])[2] > 0.);
  for (unsigned int v = 0; v < die.vertices().size(); ++v)
    n_inner_rim +=
      die.on_rim(v) && std::abs(std::hypot(die.vertices()[v][0], die.vertices()[v][1]) - outer) > 1e-9;
  // The mirror image of each point must be as far from the die as the point is.
  const ClosestFeature closest(die);
  const auto           distance = [&](const Vec3 &X) {
    return project_on_feature(die, die.vertices(), closest(X), X, Vec3()).delta;
  };
  double largest = 0.;
  for (unsigned int i = 0; i < 500; ++i)
  {
    const double r = 0.9 * outer * std::sqrt((i + 0.5) / 500.), phi = 2.4 * i, z = 20. * std::sin(i) - 5.;
    for (unsigned int s = 0; s < n_mirrors; ++s)
    {
      const double mirrored = 2. * M_PI * s / n_mirrors - phi;
      largest               = std::max(largest,
                         std::abs(distance(Vec3({r * std::cos(phi), r * std::sin(phi), z})) -
                                  distance(Vec3({r * std::cos(mirrored), r * std::sin(mirrored), z}))));
    }
  }
  std::cout << name << ": " << die.vertices().size() << " vertices, " << die.n_facets()
            << " facets, looking down " << n_down << ", rim inside " << n_inner_rim
            << ", mirror images within 1e-10: " << yes(largest < 1e-10) << "\n";
}

/// Largest distance of points on the facets (corners, middles of edges, centres) from a body of revolution.
double bell_error(const TriangleSurface &die, const BellShape<double> &shape)
{
  const auto  &p     = shape.profile;
  const double draft = p.draft * M_PI / 180., turn = M_PI / 2. - draft, tangent = std::tan(turn / 2.);
  // Signed distance of the smooth section is that of the nearest of its five parts.
  const auto distance = [&](const double r, const double z) {
    const double o = shape.mouth - r, out = -p.edge * tangent,
                 in = p.depth * std::tan(draft) + p.fillet * tangent;
    const auto arc  = [&](const double o_c, const double z_c, const double radius, const double side) {
      const double a = std::atan2(side * (o - o_c), side * (z - z_c));
      return a >= -1e-9 && a <= turn + 1e-9 ? std::abs(std::hypot(o - o_c, z - z_c) - radius) : 1e300;
    };
    const double wall   = std::abs(o * std::cos(draft) + z * std::sin(draft));
    const double floor  = o >= in - 1e-9 ? std::abs(z + p.depth) : 1e300;
    const double face   = o <= out + 1e-9 ? std::abs(z) : 1e300;
    const double along  = -z * std::cos(draft) + o * std::sin(draft);
    const double length = p.depth / std::cos(draft);
    const double on_wall =
      along >= p.edge * tangent - 1e-9 && along <= length - p.fillet * tangent + 1e-9 ? wall : 1e300;
    return std::min(
      {floor, face, on_wall, arc(out, -p.edge, p.edge, 1.), arc(in, -p.depth + p.fillet, p.fillet, -1.)});
  };
  double error = 0.;
  for (const Triangle &t : die.triangles())
    for (unsigned int c = 0; c < 3; ++c)
    {
      const Vec3 &a = die.vertices()[t[c]], &b = die.vertices()[t[(c + 1) % 3]], m = 0.5 * (a + b);
      // Chords of the innermost and outermost rings run inside flat floor and face.
      for (const Vec3 &x : {a, m})
        error = std::max(error, distance(std::hypot(x[0], x[1]), x[2]));
    }
  return error;
}

/// Floor, fillet, wall and edge of a bell, integrated over z.
double bell_volume(const BellShape<double> &shape)
{
  const auto  &p     = shape.profile;
  const double draft = p.draft * M_PI / 180., turn = M_PI / 2. - draft, tangent = std::tan(turn / 2.);
  const double out = p.edge * tangent, in = p.depth * std::tan(draft) + p.fillet * tangent;
  const double z_fillet = -p.depth + p.fillet * (1. - std::cos(turn)),
               z_edge   = -p.edge * (1. - std::cos(turn));
  const auto radius     = [&](const double z) {
    if (z < z_fillet)
      return shape.mouth - in + std::sqrt(p.fillet * p.fillet - std::pow(z + p.depth - p.fillet, 2));
    if (z > z_edge)
      return shape.mouth + out - std::sqrt(p.edge * p.edge - std::pow(z + p.edge, 2));
    return shape.mouth + z * std::tan(draft);
  };
  double             volume = 0.;
  const unsigned int n      = 200000;
  for (unsigned int i = 0; i < n; ++i)
    volume += M_PI * std::pow(radius(-p.depth * (i + 0.5) / n), 2) * p.depth / n;
  return volume;
}

template <typename Number>
std::vector<Number *> numbers(TripodShape<Number> &s)
{
  return {&s.hub,
          &s.width,
          &s.length,
          &s.corner,
          &s.outer,
          &s.profile.depth,
          &s.profile.draft,
          &s.profile.edge,
          &s.profile.fillet};
}

template <typename Number>
std::vector<Number *> numbers(BellShape<Number> &s)
{
  return {&s.mouth, &s.outer, &s.profile.depth, &s.profile.draft, &s.profile.edge, &s.profile.fillet};
}

template <template <typename> class Shape, typename Make>
void check_derivatives(const std::string &name, Shape<double> shape, const Make &make)
{
  double       largest = 0., still = 1e300;
  const double h = 1e-4;
  for (unsigned int i = 0; i < numbers(shape).size(); ++i)
  {
    Shape<Dual> dual;
    for (unsigned int j = 0; j < numbers(shape).size(); ++j)
    {
      *numbers(dual)[j]                 = Dual(1, 0, *numbers(shape)[j]);
      numbers(dual)[j]->fastAccessDx(0) = i == j;
    }
    Shape<double> plus = shape, minus = shape;
    *numbers(plus)[i] += h;
    *numbers(minus)[i] -= h;
    const auto d = make(dual).vertices;
    const auto p = make(plus).vertices, m = make(minus).vertices;
    double     size = 0.;
    for (std::size_t v = 0; v < d.size(); ++v)
      for (unsigned int k = 0; k < 3; ++k)
      {
        const double derivative = d[v][k].hasFastAccess() ? d[v][k].dx(0) : 0.;
        largest                 = std::max(largest, std::abs(derivative - (p[v][k] - m[v][k]) / (2. * h)));
        size                    = std::max(size, std::abs(derivative));
      }
    still = std::min(still, size);
  }
  std::cout << name << ": derivatives within 1e-7 of differences: " << yes(largest < 1e-7)
            << ", every parameter moves vertices: " << yes(still > 0.1) << "\n";
}

template <typename Make>
void show_error(const Make &make)
{
  try
  {
    make();
    std::cout << "  no error\n";
  }
  catch (const Error &error)
  {
    std::cout << "  " << error.what() << "\n";
  }
}

void check_refusals()
{
  const auto tripod = [](const std::function<void(TripodShape<double> &)> &change) {
    TripodShape<double> shape;
    change(shape);
    show_error([&]() { make_tripod("Die a/Tripod", shape, 0.05); });
  };
  tripod([](auto &s) { s.width = 5.; });
  tripod([](auto &s) { s.corner = 1.; });
  tripod([](auto &s) { s.hub = 10.; });
  tripod([](auto &s) { s.corner = 500.; });
  tripod([](auto &s) { s.length = 36.; });
  tripod([](auto &s) { s.outer = 56.; });
  tripod([](auto &s) { s.profile.depth = 3.; });
  tripod([](auto &s) { s.profile.edge = 0.; });
  tripod([](auto &s) { s.profile.draft = 85.; });
  BellShape<double> narrow, small;
  narrow.mouth = 35.;
  small.outer  = 60.;
  show_error([&]() { make_bell("Die a/Bell", narrow, 0.05); });
  show_error([&]() { make_bell("Die a/Bell", small, 0.05); });
}

int main()
{
  const TripodShape<double> tripod;
  const BellShape<double>   bell;
  check_surface("tripod", surface(make_tripod("die", tripod, 0.05)), tripod.outer, 3);
  check_surface("bell", surface(make_bell("die", bell, 0.05)), bell.outer, 4);
  std::cout
    << "bell, distance from the smooth shape / chord error; 1 - volume / Pappus' volume, / chord error\n";
  for (const double error : {0.4, 0.1, 0.025})
  {
    const TriangleSurface die = surface(make_bell("die", bell, error));
    std::printf(
      "  %.2f %.4f\n", bell_error(die, bell) / error, (1. - cavity_volume(die) / bell_volume(bell)) / error);
  }
  const auto forged = [&](const double error) {
    const TriangleSurface die = surface(make_tripod("die", tripod, error));
    return 2. * cavity_volume(die);
  };
  std::printf("tripod, cavities of two dies: %.0f %.0f %.0f mm^3; billet %.0f mm^3\n",
              forged(0.2),
              forged(0.05),
              forged(0.0125),
              M_PI * 20. * 20. * 60.);
  check_derivatives<TripodShape>("tripod", tripod, [](const auto &s) { return make_tripod("die", s, 0.1); });
  check_derivatives<BellShape>("bell", bell, [](const auto &s) { return make_bell("die", s, 0.1); });
  std::cout << "refused\n";
  check_refusals();
}
