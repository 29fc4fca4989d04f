// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Central differences of a function that bends, against a slope that is right and one that is wrong: what two steps
// extrapolate to meets the first to rounding, which no step does, and is as far from the second as that is wrong. And
// derivatives beside differences that decide anew: which are doubtful.
#include <retroforge/verification/check.h>

#include <cmath>
#include <cstdio>

using namespace retroforge;

namespace
{
  /// Of sin(x) + 1e3 x^3 at 0, whose slope is 1, at two steps.
  double error_of(const double slope)
  {
    CheckRow row;
    row.adjoint = slope;
    for (const double h : {1e-3, 1e-4})
    {
      DifferenceRow difference;
      difference.step             = h;
      difference.replayed_central = std::sin(h) / h + 1e3 * h * h;
      row.steps.push_back(difference);
    }
    return row.best_replayed_error();
  }

  /// Whether a derivative is doubtful beside differences that decide anew, which have a slope and a jump from -h
  /// to h by turns of its sign.
  bool is_doubtful(const double adjoint, const double slope, const double jump)
  {
    CheckRow row;
    row.adjoint          = adjoint;
    row.is_zero          = false;
    row.least_difference = 1e-5; // of a value of 1 by a parameter of scale 1
    double sign          = 1.;
    for (const double h : {1e-2, 1e-3, 1e-4, 1e-5})
    {
      DifferenceRow difference;
      difference.step         = h;
      difference.free_central = slope + 0.5 * (sign *= -1.) * jump / h;
      row.steps.push_back(difference);
    }
    return row.is_doubtful();
  }
} // namespace

int main()
{
  const auto yes = [](const bool condition) { return condition ? "yes" : "NO"; };
  std::printf("the right slope: within 1e-12: %s\n", yes(error_of(1.) < 1e-12));
  std::printf("one that is 1e-6 off: told to 1e-9: %s\n", yes(std::abs(error_of(1. + 1e-6) - 1e-6) < 1e-9));
  std::printf("decided anew 28 times as steep, of the other sign, or nothing: doubtful: %s\n",
              yes(is_doubtful(0.014, 0.4, 0.) && is_doubtful(-1., 1., 0.) && is_doubtful(1., 1e-3, 0.)));
  std::printf("a third beside it, or hidden by jumps: not doubtful: %s\n",
              yes(!is_doubtful(1., 1.33, 0.) && !is_doubtful(1., 3., 1.)));
}
