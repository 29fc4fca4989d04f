// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Sizes on an octree, and what gaps ask for.
// - Layer: the source wants 0.8 + 2 |z|, which is steeper than the growth of 0.3. Graded it is 0.8 + 0.3 |z|,
//   at most 4, by hand: corners lie in z = 0, and straight lines between corners are exact.
// - Point: the source wants 0.8 at the origin and nothing elsewhere: 0.8 + 0.3 |x| along an axis; elsewhere
//   it is more, for paths between corners are longer than straight ones and a cone is below what is linear
//   between its corners, but by less than 0.3 mm. Along edges of leaves sizes change by at most the growth.
// - 2:1: across each side, edge and corner of a leaf is one at most twice as large.
// - Leaves in Morton order fill the root cube.
// - Two planes 3 mm apart: 3/2.5 = 1.2 everywhere between, of the gap and of its octree; nothing where they are
//   14 mm apart, for the element size is 4; one plane and a symmetry plane 1.5 mm away: the same 1.2. Planes
//   at 50 and at 70 degrees: the wedge's formula, and nothing.
// - Sphere over a plane, R = 20, 2 mm apart: on the axis 2/2.5, clamped to nothing; beside it  (|x - m| - R + z)
//   / (2 cos - 1) / 2.5, within the error of the sphere's facets.
// - All ranks have the same octree to the last bit, whatever their number.

#include <deal.II/base/mpi.h>

#include <retroforge/remeshing/gap_sizes.h>
#include <retroforge/remeshing/size_octree.h>

#include <cmath>
#include <cstdio>
#include <cstring>

#include "../element/element_test_tools.h"
#include "../geometry/geometry_test_tools.h"

using namespace retroforge;

namespace
{
  constexpr double smallest = 0.8, largest = 4., growth = 0.3;

  bool print_here = true;

  template <typename... Values>
  void print(const char *format, const Values &...values)
  {
    if (print_here)
      std::printf(format, values...);
  }

  /// Farther inside than the leaves at the domain's rim, which have corners that nobody asks the source for.
  bool is_inside(const Vec3 &x)
  {
    return std::max({std::abs(x[0]), std::abs(x[1]), std::abs(x[2])}) < 9.6;
  }

  /// Boxes of 2 mm that fill a cube around the origin.
  std::vector<BoundingBox> filled(const double half)
  {
    std::vector<BoundingBox> boxes;
    for (double x = -half; x < half; x += 2.)
      for (double y = -half; y < half; y += 2.)
        for (double z = -half; z < half; z += 2.)
        {
          boxes.emplace_back(Vec3({x, y, z}));
          boxes.back().include(Vec3({x + 2., y + 2., z + 2.}));
        }
    return boxes;
  }

  SizeOctree octree(const SizeSource &source, const double half = 10.)
  {
    return SizeOctree(filled(half), source, {smallest, largest, growth});
  }

  void check_layer()
  {
    const SizeOctree h = octree({[](const Vec3 &x) { return 0.8 + 2. * std::abs(x[2]); },
                                 [](const Vec3 &x, const double distance) {
                                   return 0.8 + 2. * std::max(std::abs(x[2]) - distance, 0.);
                                 }});
    Random           random;
    double           off = 0.;
    for (unsigned int i = 0; i < 2000; ++i)
      if (const Vec3 x = 9.6 * random.vector(); is_inside(x) && std::abs(x[2]) < 6.)
        off = std::max(off, std::abs(h(x) - (0.8 + 0.3 * std::abs(x[2]))));
    print("layer: graded to rounding: %s; far away %.3g\n", yes(off < 1e-12), h(Vec3({3., 0., 99.})));
  }

  SizeOctree around_a_point()
  {
    return octree(
      {[](const Vec3 &x) { return x.norm() < 1e-9 ? 0.8 : 99.; },
       [](const Vec3 &x, const double distance) { return x.norm() > distance + 1e-9 ? 99. : 0.8; }});
  }

  void check_point()
  {
    constexpr double unit = 25.6 / (1u << 20);
    const SizeOctree h    = around_a_point();
    Random           random;
    double           axis = 0., least = 99., most = -99., steepest = 0.; // per lattice unit, 25.6 mm / 2^20
    for (const double x : {0.8, 1.6, 3.2, 6.4})
      axis = std::max(axis, std::abs(h(Vec3({0., x, 0.})) - 0.8 - 0.3 * x));
    for (const auto &leaf : h.leaves())
      for (unsigned int v = 0; v < 8; ++v)
        for (unsigned int i = 0; i < 3; ++i)
          steepest = std::max(steepest, std::abs(leaf.size[v] - leaf.size[v ^ (1u << i)]) / leaf.width);
    for (unsigned int i = 0; i < 2000; ++i)
    {
      const Vec3 x = 5. * random.vector();
      if (!is_inside(x) || x.norm() > 5. || x.norm() < 1.)
        continue;
      const double off = h(x) - 0.8 - 0.3 * x.norm();
      least            = std::min(least, off);
      most             = std::max(most, off);
    }
    print(
      "point: along an axis %s, 0 to 0.3 mm more elsewhere: %s; along edges by the growth at most: %s, and "
      "by that somewhere: %s\n",
      yes(axis < 1e-12),
      yes(least > -1e-12 && most < 0.3),
      yes(steepest < 0.3 * unit * (1. + 1e-9)),
      yes(steepest > 0.29 * unit));
  }

  /// Places of the corners of a key.
  std::array<std::int64_t, 3> place_of(const std::uint64_t key)
  {
    std::array<std::int64_t, 3> place{};
    for (unsigned int b = 0; b < 21; ++b)
      for (unsigned int i = 0; i < 3; ++i)
        place[i] |= static_cast<std::int64_t>((key >> (3 * b + i)) & 1u) << b;
    return place;
  }

  void check_balance()
  {
    const SizeOctree h      = around_a_point();
    const auto      &leaves = h.leaves();
    unsigned int     wrong = 0, unequal = 0, same_key = 0;
    double           volume = 0.;
    for (std::size_t a = 0; a < leaves.size(); ++a)
    {
      const auto   p = place_of(leaves[a].key);
      const double w = leaves[a].width;
      volume += std::pow(w / (1u << 20), 3.);
      same_key += a > 0 && leaves[a].key <= leaves[a - 1].key;
      for (std::size_t b = 0; b < a; ++b)
      {
        const auto   q     = place_of(leaves[b].key);
        const double v     = leaves[b].width;
        bool         touch = true;
        for (unsigned int i = 0; i < 3; ++i)
          touch = touch && p[i] <= q[i] + v && q[i] <= p[i] + w;
        wrong += touch && (w > 2. * v || v > 2. * w);
        unequal += touch && w != v;
      }
    }
    print("2:1: wrong %u, of unequal neighbours %s; leaves fill the cube: %s, in order: %s\n",
          wrong,
          unequal > 100 ? "many" : "FEW",
          yes(std::abs(volume - 1.) < 1e-12),
          yes(same_key == 0));
  }

  std::vector<DieState<double>> at_rest(const std::size_t n)
  {
    return std::vector<DieState<double>>(n);
  }

  Die plane(const Vec3 &point, const Vec3 &facing)
  {
    return Die("plane", point, facing);
  }

  void check_planes()
  {
    const auto source = [](const GapSizes &gaps, const std::vector<DieState<double>> &states) {
      return SizeSource{[&](const Vec3 &x) { return gaps(x, states, largest); },
                        [&](const Vec3 &x, const double r) { return gaps.below(x, r, states, largest); }};
    };
    std::vector<Die> dies   = {plane(Vec3(), Vec3({0., 0., 1.})),
                               plane(Vec3({0., 0., 14.}), Vec3({0., 0., -1.}))};
    auto             states = at_rest(2);
    const GapSizes   gaps(dies, {}, 2.5, smallest);
    const Vec3       x({1., 2., 0.7});
    print("planes 14 mm apart: %.4g;", gaps(x, states, largest));
    states[1].displacement[2] = -11.;
    const SizeOctree h        = octree(source(gaps, states));
    Random           random;
    double           off = 0.;
    for (unsigned int i = 0; i < 1000; ++i)
    {
      Vec3 at = 10. * random.vector();
      at[2]   = 1.5 + 0.15 * at[2];
      off     = std::max({off, std::abs(h(at) - 1.2), std::abs(gaps(at, states, largest) - 1.2)});
    }
    print(" 3 mm: 1.2 to rounding %s;", yes(off < 1e-12));
    states[1].in_press = 0;
    print(" one stands outside the press: %.4g;", gaps(x, states, largest));
    states[1].in_press        = 1;
    states[1].displacement[2] = -14.02;
    print(" closed: %.4g\n", gaps(x, states, largest));

    const std::vector<Die> one = {dies[0]};
    const GapSizes         half(one, {Plane{Vec3({0., 0., 1.5}), Vec3({0., 0., 1.})}}, 2.5, smallest);
    print("one plane and one of symmetry: %.4g, none asked for: %.4g\n",
          half(x, at_rest(1), largest),
          GapSizes(one, {}, 2.5, smallest)(x, at_rest(1), largest));
    for (const double degrees : {0., 30., 50., 70.})
    {
      const double           angle = degrees * M_PI / 180.;
      const std::vector<Die> wedge = {
        dies[0], plane(Vec3({0., 0., 4.}), Vec3({std::sin(angle), 0., -std::cos(angle)}))};
      const GapSizes of_wedge(wedge, {}, 2.5, 1e-3);
      const double   exact = (1. + 3. * std::cos(angle)) / (2. * std::cos(angle) - 1.) / 2.5;
      const double   size  = of_wedge(Vec3({0., 0., 1.}), at_rest(2), largest);
      print("planes at %.0f degrees: as the formula %s%s\n",
            degrees,
            yes(std::abs(size - (degrees < 60. ? std::min(exact, largest) : largest)) < 1e-12),
            size == largest ? ", that is nothing" : "");
    }
  }

  void check_sphere()
  {
    const double         R    = 20.;
    TriangleSurface      ball = sphere(5);
    NodalVectors<double> x    = ball.vertices();
    for (Vec3 &v : x)
      v = R * v + Vec3({0., 0., R + 2.});
    const std::vector<Die> dies = {plane(Vec3(), Vec3({0., 0., 1.})),
                                   Die("ball", TriangleSurface("ball", x, ball.triangles()), 5.)};
    const GapSizes         gaps(dies, {}, 2.5, 1e-3);
    Random                 random;
    double                 off = 0.;
    unsigned int           n   = 0;
    for (unsigned int i = 0; i < 500; ++i)
    {
      Vec3 at            = 8. * random.vector();
      at[2]              = 0.1 * std::abs(at[2]);
      const Vec3   from  = at - Vec3({0., 0., R + 2.});
      const double delta = from.norm() - R, c = -from[2] / from.norm();
      if (c <= 0.6 || delta < 0.)
        continue;
      ++n;
      const double exact = std::min((delta + at[2]) / (2. * c - 1.) / 2.5, largest);
      off                = std::max(off, std::abs(gaps(at, at_rest(2), largest) - exact));
    }
    print("sphere over a plane: on the axis %.3f, beside it within 0.01 mm: %s of %s\n",
          gaps(Vec3({0., 0., 0.4}), at_rest(2), largest),
          yes(off < 0.01),
          n > 100 ? "many" : "FEW");
  }

  /// A number that shows each bit of an octree.
  void check_ranks()
  {
    const SizeOctree h   = around_a_point();
    std::uint64_t    sum = h.n_leaves();
    const auto       add = [&](const std::uint64_t bits) { sum = (sum ^ bits) * 1099511628211ull; };
    for (const auto &leaf : h.leaves())
    {
      add(leaf.key);
      add(leaf.width);
      for (const double size : leaf.size)
      {
        std::uint64_t bits;
        std::memcpy(&bits, &size, sizeof bits);
        add(bits);
      }
    }
    const auto low  = dealii::Utilities::MPI::min(static_cast<double>(sum >> 12), MPI_COMM_WORLD),
               high = dealii::Utilities::MPI::max(static_cast<double>(sum >> 12), MPI_COMM_WORLD);
    print("the same on all ranks: %s; leaves %u\n", yes(low == high), h.n_leaves());
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  print_here = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  check_layer();
  check_point();
  check_balance();
  check_planes();
  check_sphere();
  check_ranks();
}
