// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Central differences of a function that bends, against a slope that is right and one that is wrong: what two steps
// extrapolate to meets the first to rounding, which no step does, and is as far from the second as that is wrong.
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
} // namespace

int main()
{
  const auto yes = [](const bool condition) { return condition ? "yes" : "NO"; };
  std::printf("the right slope: within 1e-12: %s\n", yes(error_of(1.) < 1e-12));
  std::printf("one that is 1e-6 off: told to 1e-9: %s\n", yes(std::abs(error_of(1. + 1e-6) - 1e-6) < 1e-9));
}
