// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <limits>
#include <vector>

namespace retroforge
{
  /// What central differences d(h) over a range of steps h have in common. A derivative that leaves something
  /// out is off a *plateau* on which they settle. Decisions that change between -h and h are *jumps* of the
  /// objective: they, and rounding, are in d as 1/h. Kinks and curvature grow with h. So
  ///   d(h) = slope + jump/h + curvature h,
  /// the jumps and the curvatures of either sign by chance, of the sizes J and C. The slope is that one of the
  /// differences for which they are least in the likelihood of Laplace,
  ///   min over slope, J, C  of  sum_k  log s_k + |d_k - slope| / s_k,     s_k = J/h_k + C h_k,
  /// which follows most differences and not those that stand out.
  struct DifferenceFit
  {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    double slope       = unknown;
    double uncertainty = unknown; ///< twice the least s_k
    double jump        = unknown; ///< 2 J: of the objective, from -h to h

    /// @param steps  h > 0
    /// @param d      of each; NaN where there is none. Where there are less than three, nothing is known.
    /// @param value  of the objective, whose last digits are no jump
    static DifferenceFit of(const std::vector<double> &steps, const std::vector<double> &d, double value);
  };
} // namespace retroforge
