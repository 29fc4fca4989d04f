// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <vector>

namespace retroforge
{
  /// The polynomial nearest to points (x, y) in the least squares, as a sum of c_k P_k(t) of polynomials
  /// orthogonal over the points,  P_{k+1} = (t - a_k) P_k - b_k P_{k-1},  with x scaled to t in [-1, 1]: well
  /// conditioned at any degree.  @cite Forsythe1957
  class PolynomialFit
  {
  public:
    /// @param x  more than `degree` different values
    PolynomialFit(const std::vector<double> &x, const std::vector<double> &y, unsigned int degree);

    double value(const double x) const { return at(x).first; }
    double slope(const double x) const { return at(x).second; }

  private:
    /// Value and slope of the terms taken up so far.
    std::pair<double, double> at(double x) const;
    /// P_k and dP_k/dt of all k that have coefficients a, b.
    std::pair<double, double> basis(unsigned int k, double t) const;
    double                    scaled(const double x) const { return (x - middle_) / half_; }

    double              middle_, half_;
    std::vector<double> a_, b_, c_;
  };
} // namespace retroforge
