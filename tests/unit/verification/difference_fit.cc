// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Proves, on differences d(h) made by hand of an objective of value 1 and derivative 1, at the steps of `check`,
// 1e-2 to 1e-7, with curvature h² (3e-3 h of a kinked one) and rounding of 1e-12 of the value: that a fit tells
//   - nothing left out and no jumps apart from a plateau of 1 %, and from jumps of 1e-6 of the value,
//   - plateau and jumps where there are both, the plateau to within what it says, the jumps to within a factor of 3,
//   - the slope where one of the differences stands out, and where some are missing;
// that where jumps of 1e-3 hide the slope it says so, and that of two differences it says nothing.

#include <retroforge/verification/difference_fit.h>

#include "../random_numbers.h"

#include <cmath>
#include <cstdio>

using namespace retroforge;

namespace
{
  const std::vector<double> steps = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7};

  enum class Signs
  {
    one,
    chance
  };

  /// @param jump  of the objective from -h to h
  std::vector<double>
  differences(const double slope, const double jump, const Signs signs, const double kinks = 0.)
  {
    RandomNumbers       random;
    std::vector<double> d;
    for (const double h : steps)
    {
      const double sign = signs == Signs::one ? 1. : random.scalar() > 0. ? 1. : -1.;
      d.push_back(slope + h * h + kinks * h + (0.5 * sign * jump + 1e-12 * random.scalar()) / h);
    }
    return d;
  }

  const char *yes(const bool is_true)
  {
    return is_true ? "yes" : "NO";
  }

  void check(const char *name, const std::vector<double> &d, const double slope, const double jump)
  {
    const DifferenceFit fit       = DifferenceFit::of(steps, d, 1.);
    const bool          has_jumps = jump > 0.;
    std::printf("%s: slope within 3 of what it says: %s, which is < 1e-3: %s, jumps %s: %s\n",
                name,
                yes(std::abs(fit.slope - slope) <= 3. * fit.uncertainty),
                yes(fit.uncertainty < 1e-3),
                has_jumps ? "within a factor of 3" : "below 1e-10",
                yes(has_jumps ? fit.jump > jump / 3. && fit.jump < 3. * jump : fit.jump < 1e-10));
  }
} // namespace

int main()
{
  check("rounding only", differences(1., 0., Signs::one), 1., 0.);
  check("plateau of 1 %", differences(1.01, 0., Signs::one), 1.01, 0.);
  check("plateau of 1 %, kinks", differences(1.01, 0., Signs::one, 3e-3), 1.01, 0.);
  check("jumps of 1e-6", differences(1., 1e-6, Signs::one), 1., 1e-6);
  check("jumps of 1e-6, signs by chance", differences(1., 1e-6, Signs::chance), 1., 1e-6);
  check("both", differences(1.01, 1e-6, Signs::one), 1.01, 1e-6);
  check("both, signs by chance", differences(1.01, 1e-6, Signs::chance), 1.01, 1e-6);
  std::vector<double> d = differences(1.01, 0., Signs::one);
  d[2] += 0.3;
  check("one stands out", d, 1.01, 0.);
  d    = differences(1.01, 0., Signs::one);
  d[0] = d[5] = NAN;
  check("some missing", d, 1.01, 0.);
  const DifferenceFit hidden = DifferenceFit::of(steps, differences(1., 1e-3, Signs::chance), 1.);
  std::printf("jumps of 1e-3 hide the slope, which is told: %s\n", yes(hidden.uncertainty > 0.01));
  std::printf("two differences say nothing: %s\n",
              yes(std::isnan(DifferenceFit::of({1e-2, 1e-3}, {1., 1.}, 1.).slope)));
  const std::vector<double> same(steps.size(), 2.);
  const DifferenceFit       exact = DifferenceFit::of(steps, same, 1.);
  std::printf("equal ones: slope %g, uncertainty < 1e-12: %s\n", exact.slope, yes(exact.uncertainty < 1e-12));
}
