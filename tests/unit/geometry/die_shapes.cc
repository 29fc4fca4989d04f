// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Tripod, bell, gear and punch. Proved: what is made is an oriented surface without cracks whose only rim is
// that of the face, every facet looks up, and it equals its mirror images; distances of the facets from the
// smooth shape stay within the chord error; the cavity's volume converges to Pappus' value, for a bell by a
// closed form; vertices' derivatives in the shape's parameters agree with central differences; measures that
// do not fit are refused; a gear's plan has the radii and angles that are asked for and turns smoothly from
// one part to the next; a punch is the body of revolution that it is said to be, with the workpiece outside
// of it. Printed too: the volume between two default tripods 20 mm apart at the floors, against the billet of
// radius 20 and height 60 that they are for.

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

template <typename Number>
std::vector<Number *> numbers(GearShape<Number> &s)
{
  return {&s.root,
          &s.tip,
          &s.reference,
          &s.tooth,
          &s.flank,
          &s.root_round,
          &s.tip_round,
          &s.outer,
          &s.profile.depth,
          &s.profile.draft,
          &s.profile.edge,
          &s.profile.fillet};
}

template <typename Number>
std::vector<Number *> numbers(PunchShape<Number> &s)
{
  return {&s.radius, &s.length, &s.draft, &s.edge};
}

/// The plan of an undrafted gear, seen at its wall.
void check_plan(const GearShape<double> &gear)
{
  std::cout << "gear, plan: chord error, largest turn between chords / sqrt(chord error) [degrees]\n";
  for (const double error : {0.1, 0.025, 0.00625})
  {
    const auto        mesh  = shape_mesh("die", gear, error);
    const double      level = -gear.profile.depth + gear.profile.fillet;
    std::vector<Vec3> plan;
    for (const Vec3 &x : mesh.vertices)
      if (std::abs(x[2] - level) < 1e-9)
        plan.push_back(x);
    const std::size_t n   = plan.size();
    double            tip = 0., root = 1e300, turn = 0., tooth = 0., flank = 0.;
    for (std::size_t i = 0; i < n; ++i)
    {
      const Vec3 &a = plan[i], &b = plan[(i + 1) % n], &c = plan[(i + 2) % n];
      const Vec3  before = b - a, after = c - b;
      tip  = std::max(tip, std::hypot(a[0], a[1]));
      root = std::min(root, std::hypot(a[0], a[1]));
      turn = std::max(turn, std::abs(std::atan2(cross_product_3d(before, after)[2], before * after)));
      // The flank of the first tooth, where it crosses the reference circle.
      const double ra = std::hypot(a[0], a[1]), rb = std::hypot(b[0], b[1]);
      if (i < n / 20 && ra >= gear.reference && rb < gear.reference)
      {
        double low = 0., high = 1.;
        for (unsigned int k = 0; k < 60; ++k)
        {
          const double middle                                    = 0.5 * (low + high);
          const Vec3   x                                         = a + middle * before;
          (std::hypot(x[0], x[1]) > gear.reference ? low : high) = middle;
        }
        const Vec3 x = a + low * before;
        tooth        = 2. * std::atan2(x[1], x[0]) * 180. / M_PI;
        flank        = std::atan2(before[1], -before[0]) * 180. / M_PI;
      }
    }
    std::printf("  %.5f %.0f; tip %.6f, root %.6f, tooth %.6f degrees, flank %.6f degrees\n",
                error,
                turn * 180. / M_PI / std::sqrt(error),
                tip,
                root,
                tooth,
                flank);
  }
}

void check_punch(const PunchShape<double> &punch)
{
  const TriangleSurface die   = surface(shape_mesh("die", punch, 0.01));
  const double          draft = punch.draft * M_PI / 180., tangent = std::tan(M_PI / 4. - draft / 2.);
  double                largest = 0.;
  for (const Vec3 &x : die.vertices())
  {
    // Of the round edge, the centre; else end or side.
    const double r = std::hypot(x[0], x[1]), centre = punch.radius - punch.edge * tangent;
    const double side = (punch.radius - r) * std::cos(draft) - x[2] * std::sin(draft),
                 edge = std::hypot(r - centre, x[2] + punch.edge) - punch.edge;
    largest           = std::max(largest, std::min({std::abs(x[2]), std::abs(side), std::abs(edge)}));
  }
  const ClosestFeature closest(die);
  const auto           distance = [&](const Vec3 &X) {
    return project_on_feature(die, die.vertices(), closest(X), X, Vec3()).delta;
  };
  std::printf(
    "punch: vertices on the smooth shape within 1e-12: %s; gap before its end %.6f, beside it %.3f, inside "
    "%.3f\n",
    yes(largest < 1e-12),
    distance(Vec3({1., 2., 3.})),
    distance(Vec3({punch.radius + punch.length / 2. * std::tan(draft) + 2., 0., -punch.length / 2.})),
    distance(Vec3({punch.radius + punch.length / 2. * std::tan(draft) - 2., 0., -punch.length / 2.})));
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

/// What a user is told of a default shape after a change.
template <template <typename> class Shape>
void refusal(const std::function<void(Shape<double> &)> &change)
{
  Shape<double> shape;
  change(shape);
  show_error([&]() { shape_mesh(std::string("Die a/") + Shape<double>::section(), shape, 0.05); });
}

void check_refusals()
{
  const auto tripod = refusal<TripodShape>;
  tripod([](auto &s) { s.width = 5.; });
  tripod([](auto &s) { s.corner = 1.; });
  tripod([](auto &s) { s.hub = 10.; });
  tripod([](auto &s) { s.corner = 500.; });
  tripod([](auto &s) { s.length = 36.; });
  tripod([](auto &s) { s.outer = 56.; });
  tripod([](auto &s) { s.profile.depth = 3.; });
  tripod([](auto &s) { s.profile.edge = 0.; });
  tripod([](auto &s) { s.profile.draft = 85.; });
  const auto bell = refusal<BellShape>;
  bell([](auto &s) { s.mouth = 35.; });
  bell([](auto &s) { s.outer = 60.; });
  const auto gear = refusal<GearShape>;
  gear([](auto &s) { s.teeth = 2; });
  gear([](auto &s) { s.teeth = 14; });
  gear([](auto &s) { s.reference = 40.; });
  gear([](auto &s) { s.tip = 53.; });
  gear([](auto &s) { s.tip_round = 6.; });
  gear([](auto &s) { s.root_round = 12.; });
  gear([](auto &s) { s.root_round = 0.; });
  gear([](auto &s) { s.outer = 38.; });
  gear([](auto &s) { s.profile.draft = 4.; });
  const auto punch = refusal<PunchShape>;
  punch([](auto &s) { s.edge = 11.; });
  punch([](auto &s) { s.length = 0.5; });
  punch([](auto &s) { s.draft = 80.; });
}

int main()
{
  const TripodShape<double> tripod;
  const BellShape<double>   bell;
  check_surface("tripod", surface(shape_mesh("die", tripod, 0.05)), tripod.outer, 3);
  check_surface("bell", surface(shape_mesh("die", bell, 0.05)), bell.outer, 4);
  std::cout
    << "bell, distance from the smooth shape / chord error; 1 - volume / Pappus' volume, / chord error\n";
  for (const double error : {0.4, 0.1, 0.025})
  {
    const TriangleSurface die = surface(shape_mesh("die", bell, error));
    std::printf(
      "  %.2f %.4f\n", bell_error(die, bell) / error, (1. - cavity_volume(die) / bell_volume(bell)) / error);
  }
  const auto forged = [&](const double error) {
    const TriangleSurface die = surface(shape_mesh("die", tripod, error));
    return 2. * cavity_volume(die);
  };
  std::printf("tripod, cavities of two dies: %.0f %.0f %.0f mm^3; billet %.0f mm^3\n",
              forged(0.2),
              forged(0.05),
              forged(0.0125),
              M_PI * 20. * 20. * 60.);
  check_derivatives<TripodShape>("tripod", tripod, [](const auto &s) { return shape_mesh("die", s, 0.1); });
  check_derivatives<BellShape>("bell", bell, [](const auto &s) { return shape_mesh("die", s, 0.1); });
  GearShape<double> drafted;
  drafted.profile.draft = 1.;
  drafted.profile.depth = 20.;
  check_surface("gear", surface(shape_mesh("die", drafted, 0.05)), drafted.outer, 10);
  check_plan(GearShape<double>());
  PunchShape<double> conical;
  conical.draft = 5.;
  check_punch(conical);
  check_derivatives<GearShape>("gear", drafted, [](const auto &s) { return shape_mesh("die", s, 0.1); });
  check_derivatives<PunchShape>("punch", conical, [](const auto &s) { return shape_mesh("die", s, 0.1); });
  std::cout << "refused\n";
  check_refusals();
}
