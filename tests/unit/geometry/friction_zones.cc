// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Zones of friction on a die: the weight of a box is 1 in it, 1/2 on a face, 1/4 on an edge, 1/8 in a corner and 0 outside;
// boxes with common faces add up to their union's weight, narrow ones too; the gradient is that of dual numbers; slope and
// curvature vanish where a weight sets in, so that it begins as 10 t^3. Zones that overlap, that have no height or that no part
// of the die is in are refused.

#include <retroforge/core/dual.h>
#include <retroforge/core/error.h>
#include <retroforge/geometry/die_parameters.h>

#include <algorithm>
#include <iostream>
#include <random>

using namespace retroforge;

namespace
{
  const char *yes(const bool condition)
  {
    return condition ? "yes" : "NO";
  }

  void weights()
  {
    const FrictionZones zones{{{Vec3({0., 0., 0.}), Vec3({10., 8., 6.})}}, 2.};
    const auto          at = [&](const double x, const double y, const double z) {
      return zones.weight(0, Vec3({x, y, z}));
    };
    std::cout << "inside " << at(5., 4., 3.) << ", on a face " << at(10., 4., 3.) << ", an edge "
              << at(10., 8., 3.) << ", a corner " << at(10., 8., 6.) << ", beyond " << at(11., 4., 3.)
              << "\n";
    std::cout << "rises within the edge: " << at(-0.5, 4., 3.) << " " << at(0.5, 4., 3.) << "\n";
  }

  void sums_and_gradients()
  {
    std::mt19937                           generator(5);
    std::uniform_real_distribution<double> uniform(-2., 12.);
    const Vec3                             low({0., 0., 0.}), high({10., 8., 6.});
    const FrictionZones                    whole{{{low, high}}, 2.};
    // In three, the middle one narrower than the edge.
    const FrictionZones parts{
      {{low, Vec3({4., 8., 6.})}, {Vec3({4., 0., 0.}), Vec3({4.7, 8., 6.})}, {Vec3({4.7, 0., 0.}), high}},
      2.};
    double worst_sum = 0., worst_gradient = 0.;
    for (unsigned int i = 0; i < 1000; ++i)
    {
      const Vec3 x({uniform(generator), uniform(generator), uniform(generator)});
      double     sum = 0.;
      for (unsigned int z = 0; z < 3; ++z)
        sum += parts.weight(z, x);
      worst_sum = std::max(worst_sum, std::abs(sum - whole.weight(0, x)));
      for (unsigned int z = 0; z < 3; ++z)
      {
        const Vec3 gradient = parts.gradient(z, x);
        for (unsigned int j = 0; j < 3; ++j)
        {
          Vector3<Dual> dual;
          for (unsigned int k = 0; k < 3; ++k)
            dual[k] = Dual(1, 0, x[k]);
          for (unsigned int k = 0; k < 3; ++k)
            dual[k].fastAccessDx(0) = k == j ? 1. : 0.;
          worst_gradient = std::max(worst_gradient, std::abs(parts.weight(z, dual).dx(0) - gradient[j]));
        }
      }
    }
    std::cout << "parts add up to the whole within 1e-15: " << yes(worst_sum < 1e-15)
              << ", gradients within 1e-14: " << yes(worst_gradient < 1e-14) << "\n";
    const double e = 1e-3;
    std::cout << "what is 1e-3 inside of where a weight sets in is of third order: "
              << whole.weight(0, Vec3({-1. + e, 4., 3.})) / (10. * std::pow(0.5 * e, 3)) << "\n";
  }

  DieParameters with_zone(const Vec3 &from, const Vec3 &to)
  {
    DieParameters die("upper");
    die.point  = Vec3({0., 0., 50.});
    die.facing = Vec3({0., 0., -1.});
    die.zones.emplace_back("flash", die.section());
    die.zones[0].from = from;
    die.zones[0].to   = to;
    return die;
  }

  void refused(DieParameters die)
  {
    try
    {
      die.check();
      std::cout << die.die().zones.boxes.size() << " zones\n";
    }
    catch (const Error &error)
    {
      std::cout << error.what() << "\n";
    }
  }
} // namespace

int main()
{
  weights();
  sums_and_gradients();
  const Vec3 low({10., 0., 45.}), high({30., 20., 55.});
  refused(with_zone(low, high));
  refused(with_zone(low, Vec3({30., 20., 45.})));
  refused(with_zone(low, Vec3({30., 20., 49.})));
  DieParameters two = with_zone(low, high);
  two.zones.push_back(two.zones[0]);
  two.zones[1].name = "land";
  refused(two);
  two.zones[1].from[0] = 30.;
  two.zones[1].to[0]   = 40.;
  refused(two);
  DieParameters punch = with_zone(Vec3({0., 0., 60.}), Vec3({20., 20., 200.}));
  punch.shape.choose<PunchDie>();
  refused(punch);
  punch.zones[0].from[0] = 100.;
  punch.zones[0].to[0]   = 110.;
  refused(punch);
}
