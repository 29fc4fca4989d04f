// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/scan/polynomial_fit.h>

#include <algorithm>
#include <utility>

namespace retroforge
{
  PolynomialFit::PolynomialFit(const std::vector<double> &x,
                               const std::vector<double> &y,
                               const unsigned int         degree)
  {
    AssertDimension(y.size(), x.size());
    Assert(degree < x.size(), dealii::ExcMessage("a polynomial needs more points than its degree"));
    const auto [least, most] = std::minmax_element(x.begin(), x.end());
    middle_                  = 0.5 * (*least + *most);
    half_                    = *most > *least ? 0.5 * (*most - *least) : 1.;
    double last_square       = 0.;
    for (unsigned int k = 0; k <= degree; ++k)
    {
      double square = 0., moment = 0., product = 0.;
      for (std::size_t i = 0; i < x.size(); ++i)
      {
        const double t = scaled(x[i]), p = basis(k, t).first;
        square += p * p;
        moment += t * p * p;
        product += p * (y[i] - value(x[i])); // of what is left: rounding of earlier terms is made good
      }
      a_.push_back(moment / square);
      b_.push_back(k == 0 ? 0. : square / last_square);
      c_.push_back(product / square);
      last_square = square;
    }
  }

  std::pair<double, double> PolynomialFit::basis(const unsigned int k, const double t) const
  {
    double p = 1., p_before = 0., slope = 0., slope_before = 0.;
    for (unsigned int j = 0; j < k; ++j)
    {
      const double next       = (t - a_[j]) * p - b_[j] * p_before;
      const double next_slope = p + (t - a_[j]) * slope - b_[j] * slope_before;
      p_before                = std::exchange(p, next);
      slope_before            = std::exchange(slope, next_slope);
    }
    return {p, slope};
  }

  std::pair<double, double> PolynomialFit::at(const double x) const
  {
    std::pair<double, double> sum(0., 0.);
    for (unsigned int k = 0; k < c_.size(); ++k)
    {
      const auto [p, slope] = basis(k, scaled(x));
      sum.first += c_[k] * p;
      sum.second += c_[k] * slope / half_;
    }
    return sum;
  }
} // namespace retroforge
