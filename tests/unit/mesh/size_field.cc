// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Graded size fields in a region of 100 x 80 x 60.
// - Gentle: the wanted size 2 + 0.1 |x - c| is smoother than the bound 0.3 on the gradient, so the field is
// the
//   wanted one up to interpolation: within 3 %, except within 14 of the kink at c (two leaves, 4 long each).
// - Steep point: wanted is 1 on one point and 8 elsewhere. At the point the field is 1; along the axes it
// grows
//   by 0.3/sqrt(3) = 0.173205 per unit, after at most two leaves (2 long each) in which it stays 1.
// - Steep sphere: wanted is 1 + 0.8 |distance to it|. For both |h(x) - h(y)| <= gradient |x - y| for pairs of
//   points far apart and 1e-3 apart (which shows continuity across leaves, too), sizes are within their
//   bounds, and not larger than wanted at the given points.
// - Outside of the region the closest point counts. Uniform, there are no leaves. Twice gives the same bits.

#include "mesh_test_tools.h"
#include <retroforge/mesh/size_field.h>

#include <algorithm>
#include <random>

using namespace retroforge;

const Vec3 width({100, 80, 60});

class Points
{
public:
  Vec3 inside()
  {
    Vec3 x;
    for (unsigned int d = 0; d < 3; ++d)
      x[d] = width[d] * (generator_() / 4294967295.);
    return x;
  }

  Vec3 direction()
  {
    Vec3 v;
    for (unsigned int d = 0; d < 3; ++d)
      v[d] = 2. * (generator_() / 4294967295.) - 1.;
    return v / v.norm();
  }

private:
  std::mt19937 generator_{1};
};

Box region()
{
  Box box((Vec3()));
  box.include(width);
  return box;
}

// Largest |h(x) - h(y)| / |x - y| over pairs of points.
double steepest(const GradedSize &h, const double distance)
{
  Points points;
  double slope = 0;
  for (unsigned int i = 0; i < 20000; ++i)
  {
    const Vec3 x = points.inside(), y = x + distance * points.direction();
    slope = std::max(slope, std::abs(h(x) - h(y)) / distance);
  }
  return slope;
}

bool within(const GradedSize &h, const SizeBounds &bounds)
{
  Points points;
  for (unsigned int i = 0; i < 20000; ++i)
  {
    const double value = h(points.inside());
    if (value < bounds.smallest * (1 - 1e-12) || value > bounds.largest * (1 + 1e-12))
      return false;
  }
  return true;
}

void report(const std::string &title, const GradedSize &h, const SizeBounds &bounds)
{
  std::cout << title
            << "\n  gradient within its bound: " << yes(steepest(h, 1e-3) <= bounds.gradient * (1 + 1e-9))
            << " " << yes(steepest(h, 1) <= bounds.gradient) << " " << yes(steepest(h, 30) <= bounds.gradient)
            << "\n  and above half of it somewhere: " << yes(steepest(h, 1e-3) > bounds.gradient / 2)
            << "\n  sizes within theirs: " << yes(within(h, bounds)) << "\n";
}

void test_gentle()
{
  const Vec3       centre({30, 40, 20});
  const auto       wanted = [&](const Vec3 &x) { return 2 + 0.1 * (x - centre).norm(); };
  const GradedSize h(region(), wanted, {centre}, {1, 20, 0.3});
  const GradedSize again(region(), wanted, {centre}, {1, 20, 0.3});
  Points           points;
  double           error = 0;
  bool             same  = true;
  for (unsigned int i = 0; i < 20000; ++i)
  {
    const Vec3 x = points.inside();
    if ((x - centre).norm() > 14)
      error = std::max(error, std::abs(h(x) / wanted(x) - 1));
    same = same && h(x) == again(x);
  }
  std::cout << "gentle\n  as wanted to 3 %: " << yes(error < 0.03)
            << "\n  at the centre not above 2: " << yes(h(centre) <= 2)
            << "\n  outside as at the closest point: " << yes(h(Vec3({-5, 200, 20})) == h(Vec3({0, 80, 20})))
            << "\n  same bits again: " << yes(same)
            << "\n  hundreds of leaves: " << yes(h.n_leaves() > 100 && h.n_leaves() < 20000) << "\n";
}

void test_point()
{
  const Vec3       point({31, 41, 23});
  const SizeBounds bounds = {1, 8, 0.3};
  const GradedSize h(
    region(), [&](const Vec3 &x) { return (x - point).norm() < 1e-9 ? 1. : 8.; }, {point}, bounds);
  report("steep point", h, bounds);
  const auto by_hand = [](const double d) { return 1 + 0.3 / std::sqrt(3.) * d; };
  bool       grows   = true;
  for (const double d : {8., 12., 16., 20.})
    for (unsigned int i = 0; i < 3; ++i)
    {
      Vec3 x = point;
      x[i] += d;
      grows = grows && h(x) <= by_hand(d) && h(x) >= by_hand(d - 4);
    }
  std::cout << "  at the point: " << h(point) << ", far away: " << h(Vec3({99, 2, 1}))
            << "\n  grows along the axes as by hand: " << yes(grows) << "\n";
}

void test_sphere()
{
  const Vec3        centre({50, 40, 30});
  const SizeBounds  bounds = {1.5, 10, 0.4};
  const auto        wanted = [&](const Vec3 &x) { return 1 + 0.8 * std::abs((x - centre).norm() - 20); };
  std::vector<Vec3> on_sphere;
  Points            points;
  for (unsigned int i = 0; i < 200; ++i)
    on_sphere.push_back(centre + 20 * points.direction());
  const GradedSize h(region(), wanted, on_sphere, bounds);
  report("steep sphere", h, bounds);
  double largest = 0;
  for (const Vec3 &x : on_sphere)
    largest = std::max(largest, h(x));
  std::cout << "  largest on the sphere: " << largest << "\n";
}

int main()
{
  test_gentle();
  test_point();
  test_sphere();
  const GradedSize                          uniform(3.5);
  const std::function<double(const Vec3 &)> size = uniform;
  std::cout << "uniform: " << size(Vec3({1, 2, 3})) << ", leaves " << uniform.n_leaves() << "\n";
  print_error("bounds", []() { GradedSize(region(), [](const Vec3 &) { return 1.; }, {}, {2, 1, 0.3}); });
}
