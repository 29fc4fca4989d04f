// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/text.h>
#include <retroforge/objective/smooth_maximum.h>

namespace retroforge
{
  namespace
  {
    /// x^p needs a scale other than zero, log-sum-exp none.
    double divisor(const double scale)
    {
      return scale > 0. ? scale : 1.;
    }
  } // namespace

  void SmoothMaximum::check(const std::string &where) const
  {
    if (kind == Kind::p_norm && !(sharpness >= 1.))
      throw Error(where,
                  "the exponent of the p-norm is " + as_text(sharpness),
                  "it must be at least 1",
                  "use 10 to 50: the larger, the nearer to the maximum");
    if (kind == Kind::log_sum_exp && !(sharpness > 0.))
      throw Error(where,
                  "the sharpness of the log-sum-exp is " + as_text(sharpness),
                  "it must be positive",
                  "use 10 to 50 divided by the maximum expected");
  }

  template <typename Number>
  Number SmoothMaximum::term(const Number &x, const Number &weight, const double scale) const
  {
    using std::exp;
    if (kind == Kind::log_sum_exp)
      return weight * exp(Number(sharpness * (x - scale)));
    if (value_of(x) <= 0.)
      return Number(0.);
    return weight * power(Number(x / divisor(scale)), Number(sharpness));
  }

  template <typename Number>
  Number SmoothMaximum::combine(const Number &sum, const Number &weights, const double scale) const
  {
    using std::log;
    if (value_of(weights) == 0.)
      return Number(0.);
    if (kind == Kind::log_sum_exp)
      return scale + log(Number(sum / weights)) / sharpness;
    return divisor(scale) * power(Number(sum / weights), Number(1. / sharpness));
  }

  double SmoothMaximum::slope(const double x, const double scale) const
  {
    if (kind == Kind::log_sum_exp)
      return sharpness * std::exp(sharpness * (x - scale));
    return x <= 0. ? 0. : sharpness / divisor(scale) * std::pow(x / divisor(scale), sharpness - 1.);
  }

#define RETROFORGE_INSTANTIATE(Number)                                               \
  template Number SmoothMaximum::term(const Number &, const Number &, double) const; \
  template Number SmoothMaximum::combine(const Number &, const Number &, double) const;
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
