// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/dual.h>

#include <array>
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

  /// A mean that lies near an extreme of weighted values x_i of any sign,
  ///   ( sum_i w_i x_i exp(x_i/s) ) / ( sum_i w_i exp(x_i/s) ):
  /// near the largest for s > 0, the least for s < 0. Unlike the log-sum-exp it is of the size of the extreme even
  /// where that has a small weight; it misses it by about 1.5 s where a hot spot is round.
  struct ExponentialMean
  {
    double smoothing; ///< s [unit of x]

    /// Returns a value's part of the two sums, at weight one.
    /// @param extreme  the true one, to which exponents are taken; the mean does not depend on it
    template <typename Number>
    std::array<Number, 2> terms(const Number &x, const double extreme) const
    {
      using std::exp;
      const Number beside = x - extreme, weight = exp(Number(beside / smoothing));
      return {{weight, Number(weight * beside)}};
    }

    /// Returns the derivatives of terms() in x.
    std::array<double, 2> slopes(const double x, const double extreme) const
    {
      const auto f = terms(x, extreme);
      return {{f[0] / smoothing, f[0] + f[1] / smoothing}};
    }

    /// Returns the mean from the completed sums.
    template <typename Number>
    Number combine(const Number &weights, const Number &sum, const double extreme) const
    {
      return extreme + sum / weights;
    }
  };
} // namespace retroforge
