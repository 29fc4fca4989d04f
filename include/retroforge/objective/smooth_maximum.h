// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/dual.h>

#include <string>

namespace retroforge
{
  /// A differentiable stand-in for the largest of weighted values x_i, weights w_i > 0 of sum W:
  ///   p-norm        ( sum_i w_i x_i^p / W )^(1/p),           for x_i >= 0 (negative ones count as zero)
  ///   log-sum-exp   1/k log( sum_i w_i exp(k x_i) / W ).
  /// Both are means, never above the maximum, and converge to it from below: with w the weight of the largest
  /// value they lie at least at  x_max (w/W)^(1/p)  and  x_max - log(W/w)/k.
  struct SmoothMaximum
  {
    enum class Kind
    {
      p_norm,
      log_sum_exp
    };

    Kind   kind      = Kind::p_norm;
    double sharpness = 20.; ///< p >= 1, dimensionless; or k > 0 [1/unit of x]

    /// @throws Error
    void check(const std::string &where) const;

    /// Returns one value's part of the sum; the weight's own sum is the caller's.
    /// @param scale  the largest value; it avoids overflow and cancels: not differentiated
    template <typename Number>
    Number term(const Number &x, const Number &weight, double scale) const;

    /// Returns the maximum from the completed sums, 0 for no weight at all.
    template <typename Number>
    Number combine(const Number &sum, const Number &weights, double scale) const;

    /// Returns  d term / dx  at weight one.
    double slope(double x, double scale) const;
  };
} // namespace retroforge
