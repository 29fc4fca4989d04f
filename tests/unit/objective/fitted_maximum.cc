// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Proves, on forces given by hand over a stroke of 1, p = 20:
//   - F = 1/(1.25 - s), of a height that goes down, is fitted exactly: what is off is M's part alone, between
//     (11/12)^(1/20) - 1 = -0.43 % and 0, with 27, 54, 108 or 270 increments. A constant force is itself.
//   - It is the force of an increment: cutting the last one in halves moves it as it moves the largest force.
//   - An increment that stands out by 5 % of its force, in the middle of a constant one, is seen by a part.
//   - A step up at the end from any height is damped to at most 1.15, and seen at all that lasts for the reach.
//   - Without fits, M is between the largest force times (share of its length)^(1/p) and the largest.
//   - Nothing (no force, negative ones, one increment) is no reason for anything but a finite number.
//   - Where increments have moved from where they were recorded, by a tenth of the reach, the fit of a height that goes
//     down is as exact.
//   - Derivatives in forces, lengths and places are those of dual numbers, to rounding, and of central differences; they
//     are compared over the maximum over the input.

#include <retroforge/objective/fitted_maximum.h>

#include "../random_numbers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

using namespace retroforge;

namespace
{
  const char *yes(const bool is_true)
  {
    return is_true ? "yes" : "NO";
  }

  using Path = ForcePath<double>;

  Path
  path_of(const std::vector<double> &ends, const std::function<double(double)> &force, const double reach)
  {
    Path   path{{}, {}, {}, {}, reach};
    double begin = 0.;
    for (const double end : ends)
    {
      path.length.push_back(end - begin);
      path.place.push_back(0.5 * (begin + end));
      path.recorded.push_back(path.place.back());
      path.force.push_back(force(path.place.back()));
      begin = end;
    }
    return path;
  }

  std::vector<double> equal(const unsigned int n)
  {
    std::vector<double> ends;
    for (unsigned int i = 1; i <= n; ++i)
      ends.push_back(double(i) / n);
    return ends;
  }

  double largest(const Path &path)
  {
    return *std::max_element(path.force.begin(), path.force.end());
  }

  const FittedMaximum maximum{SmoothMaximum()};

  double off(const Path &path)
  {
    return maximum.value(path) / largest(path) - 1.;
  }

  double hyperbola(const double s)
  {
    return 1. / (1.25 - s);
  }

  void check_values()
  {
    const double least = std::pow(11. / 12., 1. / 20.) - 1.;
    for (const unsigned int n : {27, 54, 108, 270})
    {
      const double of_hyperbola = off(path_of(equal(n), hyperbola, 0.08));
      std::printf("%3u increments: a height that goes down %.2f %%, as M alone: %s, constant: %s\n",
                  n,
                  100. * of_hyperbola,
                  yes(of_hyperbola <= 1e-12 && of_hyperbola > least &&
                      std::abs(of_hyperbola - off(path_of(equal(n), hyperbola, 0.))) < 1e-12),
                  yes(std::abs(off(path_of(
                        equal(n), [](double) { return 3.; }, 0.08))) < 1e-12));
    }
    Path moved_path = path_of(equal(54), hyperbola, 0.08);
    for (std::size_t i = 0; i < moved_path.size(); ++i)
    {
      moved_path.place[i] += 0.008 * std::sin(double(i));
      moved_path.force[i] = hyperbola(moved_path.place[i]);
    }
    const double recorded = maximum.value(path_of(equal(54), hyperbola, 0.08));
    std::printf("moved increments, fitted where they were: %s\n",
                yes(std::abs(maximum.value(moved_path) / recorded - 1.) < 1e-3));
    std::vector<double> cut = equal(54);
    cut.insert(cut.end() - 1, 1. - 0.5 / 54.);
    const Path   whole = path_of(equal(54), hyperbola, 0.08), halves = path_of(cut, hyperbola, 0.08);
    const double moved = maximum.value(halves) / maximum.value(whole) - 1.;
    std::printf("the last increment in halves: %.2f %%, of the largest force %.2f %%\n",
                100. * moved,
                100. * (largest(halves) / largest(whole) - 1.));
    Path spike = path_of(
      equal(54), [](double) { return 1.; }, 0.08);
    spike.force[27] += 0.05;
    std::printf("an increment of 5 %% more in a constant force: %.2f %%\n",
                100. * (maximum.value(spike) - 1.));
    double highest = 0., lowest = 2.;
    for (const unsigned int n : {30, 100, 300})
      for (const double before : {0., 0.02, 0.05, 0.1, 0.2, 0.5, 0.8})
        for (unsigned int k = 1; k < n; ++k)
        {
          const double value = maximum.value(path_of(
            equal(n), [&](const double s) { return s > 1. - k / double(n) ? 1. : before; }, 0.08));
          highest            = std::max(highest, value);
          if (k >= 0.08 * n)
            lowest = std::min(lowest, value);
        }
    std::printf("steps up: at most 1.15: %s, %.3f; if it lasts, at least the force but for 2 %%: %s\n",
                yes(highest <= 1.15),
                highest,
                yes(lowest > 0.98));
  }

  void check_maxima()
  {
    for (const auto kind : {SmoothMaximum::Kind::p_norm, SmoothMaximum::Kind::log_sum_exp})
      for (const double sharpness : {5., 20., 80.})
      {
        const bool is_norm = kind == SmoothMaximum::Kind::p_norm;
        const Path path    = path_of(
          equal(8), [](const double s) { return 1. + s * s; }, 0.);
        const double        most = largest(path);
        const FittedMaximum any(SmoothMaximum{kind, is_norm ? sharpness : sharpness / most});
        const double        share = 1. / 8., value = any.value(path);
        const double        bound =
          is_norm ? most * std::pow(share, 1. / sharpness) : most * (1. + std::log(share) / sharpness);
        std::printf("%s, sharpness %g: %.2f %% off, within its bounds: %s\n",
                    is_norm ? "p-norm" : "log-sum-exp",
                    sharpness,
                    100. * (value / most - 1.),
                    yes(value <= most * (1. + 1e-14) && value >= bound));
      }
  }

  void check_nothing()
  {
    const auto is_finite = [](const Path &path) {
      const Path bar    = maximum.reverse(path);
      bool       finite = std::isfinite(maximum.value(path));
      for (const auto *x : {&bar.force, &bar.length, &bar.place})
        finite = std::all_of(x->begin(), x->end(), [](const double y) { return std::isfinite(y); }) && finite;
      return finite;
    };
    std::printf("finite: no increment %s, no force %s, negative ones %s, some of both %s, one increment %s\n",
                yes(is_finite(path_of({}, hyperbola, 0.08))),
                yes(is_finite(path_of(
                  equal(9), [](double) { return 0.; }, 0.08))),
                yes(is_finite(path_of(
                  equal(9), [](double) { return -1.; }, 0.08))),
                yes(is_finite(path_of(
                  equal(9), [](const double s) { return s - 0.5; }, 0.08))),
                yes(is_finite(path_of(equal(1), hyperbola, 0.08))));
  }

  void check_derivatives(const char *name, const Path &path, const SmoothMaximum &kind)
  {
    const FittedMaximum any(kind);
    const Path          bar = any.reverse(path);
    ForcePath<Dual>     dual{{path.force.begin(), path.force.end()},
                         {path.length.begin(), path.length.end()},
                         {path.place.begin(), path.place.end()},
                         path.recorded,
                         path.reach};
    double              of_dual = 0., of_differences = 0.;
    const auto compare = [&](std::vector<Dual> ForcePath<Dual>::*duals, std::vector<double> Path::*doubles) {
      const double size = any.value(path) / *std::max_element((path.*doubles).begin(), (path.*doubles).end());
      for (std::size_t i = 0; i < path.size(); ++i)
      {
        (dual.*duals)[i].fastAccessDx(0) = 1.;
        const double slope               = any.value(dual).dx(0);
        (dual.*duals)[i].fastAccessDx(0) = 0.;
        const auto moved                 = [&](const double h) {
          Path at = path;
          (at.*doubles)[i] += h;
          return any.value(at);
        };
        const double h = 1e-5 * (path.*doubles)[i];
        of_dual        = std::max(of_dual, std::abs(slope - (bar.*doubles)[i]) / size);
        of_differences =
          std::max(of_differences, std::abs((moved(h) - moved(-h)) / (2. * h) - (bar.*doubles)[i]) / size);
      }
    };
    compare(&ForcePath<Dual>::force, &Path::force);
    compare(&ForcePath<Dual>::length, &Path::length);
    compare(&ForcePath<Dual>::place, &Path::place);
    std::printf("%s: reverse and dual numbers < 1e-11: %s, differences < 1e-6: %s\n",
                name,
                yes(of_dual < 1e-11),
                yes(of_differences < 1e-6));
  }
} // namespace

int main()
{
  check_values();
  check_maxima();
  check_nothing();
  RandomNumbers random;
  const auto    rough  = [&](const double s) { return hyperbola(s) * (1. + 0.02 * random.scalar()); };
  const Path    rising = path_of(equal(40), rough, 0.08);
  const Path    damped = path_of(
    equal(40), [](const double s) { return s > 0.93 ? 1. + 0.1 * s : 0.2 + 0.1 * s; }, 0.2);
  std::printf("the damped one is: %s\n", yes(off(damped) > 0.05));
  check_derivatives("p-norm", rising, {});
  check_derivatives("p-norm, damped", damped, {});
  check_derivatives("p-norm, not fitted", path_of(equal(40), rough, 0.), {});
  check_derivatives("log-sum-exp", rising, {SmoothMaximum::Kind::log_sum_exp, 5.});
}
