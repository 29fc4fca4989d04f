// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/error.h>
#include <retroforge/core/text.h>
#include <retroforge/objective/effort.h>
#include <retroforge/objective/path_objective.h>

namespace retroforge
{
  /// A smooth maximum of a stress x over places and time [MPa],
  ///   ( sum_i dt_i sum_l S_l x_l^gamma / sum_i dt_i sum_l S_l )^(1/gamma),
  /// dt_i the part of increment i in a window. Class T makes the two sums over places the first integrals of a row, x over a
  /// reference, and returns others behind them. Zero where nothing has a weight.
  template <typename T>
  class PathMaximumOf : public PathObjectiveOf<T>
  {
  public:
    static constexpr unsigned int n_terms = 2;

    /// @param what       the objective, for messages
    /// @param exponent   gamma >= 1, 10 to 50 for a maximum
    /// @param reference  a stress of the expected size, so that x^gamma neither overflows nor vanishes: it cancels
    /// [MPa]   @throws Error
    PathMaximumOf(const std::string &what,
                  const double       exponent,
                  const double       reference,
                  const PathWindow  &window = {})
        : exponent_(exponent), reference_(reference), window_(window)
    {
      if (!(exponent >= 1.))
        throw Error(what,
                    "the exponent is " + as_text(exponent),
                    "it must be at least 1",
                    "use 10 to 50: the larger, the nearer to the maximum");
      if (!(reference > 0.))
        throw Error(what,
                    "the reference is " + as_text(reference) + " MPa",
                    "it must be positive",
                    "use the stress expected, or the consistency K");
      window.check(what);
    }

    std::string unit() const override { return "MPa"; }

    template <typename Number>
    std::vector<Number> terms(const PathRow<Number> &row, double) const
    {
      const Number time = window_.time_inside(row);
      return {Number(time * row.integrals[0]), Number(time * row.integrals[1])};
    }

    template <typename Number>
    Number combine(const std::vector<Number> &sums, double) const
    {
      if (value_of(sums[0]) <= 0. || value_of(sums[1]) <= 0.)
        return Number(0.);
      return reference_ * power(Number(sums[0] / sums[1]), Number(1. / exponent_));
    }

  protected:
    const PathWindow &window() const { return window_; }

    /// Returns (x/reference)^gamma, zero where x pulls.
    template <typename Number>
    Number raised(const Number &x) const
    {
      return power(Number(x / reference_), Number(exponent_));
    }

    /// Returns the derivative of raised() in x.
    double slope(const double x) const { return x > 0. ? exponent_ * raised(x) / x : 0.; }

    double exponent() const { return exponent_; }

  private:
    double     exponent_, reference_;
    PathWindow window_;
  };
} // namespace retroforge
