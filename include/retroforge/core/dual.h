// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/template_constraints.h>

#include <Sacado.hpp>

#include <cmath>

// deal.II's tensors know the dynamic forward-mode types of Sacado only; these lines teach them the fixed-size
// ones.
namespace dealii
{
  template <int N>
  struct EnableIfScalar<Sacado::Fad::SFad<double, N>>
  {
    using type = Sacado::Fad::SFad<double, N>;
  };

  namespace internal
  {
    template <int N>
    struct ProductTypeImpl<Sacado::Fad::SFad<double, N>, Sacado::Fad::SFad<double, N>>
    {
      using type = Sacado::Fad::SFad<double, N>;
    };

    template <int N>
    struct ProductTypeImpl<Sacado::Fad::SFad<double, N>, double>
    {
      using type = Sacado::Fad::SFad<double, N>;
    };

    template <int N>
    struct ProductTypeImpl<double, Sacado::Fad::SFad<double, N>>
    {
      using type = Sacado::Fad::SFad<double, N>;
    };
  } // namespace internal
} // namespace dealii

namespace retroforge
{
  /// One directional derivative, carried forward; the number type of the tangent method.
  using Dual = Sacado::Fad::SFad<double, 1>;

  template <typename Number>
  double value_of(const Number &x)
  {
    return Sacado::ScalarValue<Number>::eval(x);
  }

  /// base^exponent for base >= 0, without the NaN derivatives of pow at base = 0:  0^0 = 1 and 0^(positive) =
  /// 0, both with zero derivative. A zero base with a negative exponent is infinite, as it should be.
  template <typename Number>
  Number power(const Number &base, const Number &exponent)
  {
    using std::exp;
    using std::log;
    if (value_of(base) > 0.)
      return exp(exponent * log(base));
    return value_of(exponent) == 0. ? Number(1.) : Number(std::pow(0., value_of(exponent)));
  }

  /// log(x) for x > 0, and 0 at x = 0: for terms x^a log(x) whose limit is zero.
  inline double log_or_zero(const double x)
  {
    return x > 0. ? std::log(x) : 0.;
  }
} // namespace retroforge
