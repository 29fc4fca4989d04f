// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/billet/spline_curve.h>

#include <algorithm>
#include <numeric>

namespace retroforge
{
  double cross(const Vec2 &a, const Vec2 &b)
  {
    return a[0] * b[1] - a[1] * b[0];
  }

  SplineCurve::SplineCurve(const std::vector<Vec2>   &control_points,
                           const unsigned int         degree,
                           const std::vector<double> &weights)
      : points_(control_points)
      , degree_(degree)
      , weights_(weights.empty() ? std::vector<double>(control_points.size(), 1.) : weights)
  {
  }

  // Knots number 0 to n + degree; the first and the last stand degree + 1 times.
  double SplineCurve::knot(const int i) const
  {
    const double spans = n_spans();
    return std::clamp((i - static_cast<int>(degree_)) / spans, 0., 1.);
  }

  // Recursion of Cox and de Boor from the indicator functions of the spans. Entry i belongs to the knots
  // i, ..., i + degree + 1; there are n + degree_ - degree of them.
  std::vector<double> SplineCurve::polynomial_basis(const double t, const unsigned int degree) const
  {
    std::vector<double> N(points_.size() + degree_, 0.);
    N[degree_ + std::min<unsigned int>(t * n_spans(), n_spans() - 1)] = 1.;
    for (unsigned int p = 1; p <= degree; ++p)
    {
      for (unsigned int i = 0; i + p < points_.size() + degree_; ++i)
      {
        const double up   = knot(i + p) - knot(i);
        const double down = knot(i + p + 1) - knot(i + 1);
        N[i]              = (up > 0. ? (t - knot(i)) / up * N[i] : 0.) +
               (down > 0. ? (knot(i + p + 1) - t) / down * N[i + 1] : 0.);
      }
      N.pop_back();
    }
    return N;
  }

  std::vector<double> SplineCurve::polynomial_basis_derivative(const double t) const
  {
    const auto          lower = polynomial_basis(t, degree_ - 1);
    std::vector<double> dN(points_.size());
    for (unsigned int i = 0; i < dN.size(); ++i)
    {
      const double up = knot(i + degree_) - knot(i), down = knot(i + degree_ + 1) - knot(i + 1);
      dN[i] = degree_ * ((up > 0. ? lower[i] / up : 0.) - (down > 0. ? lower[i + 1] / down : 0.));
    }
    return dN;
  }

  std::vector<double> SplineCurve::basis(const double t) const
  {
    auto         N   = polynomial_basis(t, degree_);
    const double sum = std::inner_product(N.begin(), N.end(), weights_.begin(), 0.);
    for (unsigned int i = 0; i < N.size(); ++i)
      N[i] *= weights_[i] / sum;
    return N;
  }

  Vec2 SplineCurve::value(const double t) const
  {
    const auto R = basis(t);
    Vec2       c;
    for (unsigned int i = 0; i < R.size(); ++i)
      c += R[i] * points_[i];
    return c;
  }

  Vec2 SplineCurve::derivative(const double t) const
  {
    const auto   N   = polynomial_basis(t, degree_);
    const auto   dN  = polynomial_basis_derivative(t);
    const Vec2   c   = value(t);
    const double sum = std::inner_product(N.begin(), N.end(), weights_.begin(), 0.);
    Vec2         dc;
    for (unsigned int i = 0; i < dN.size(); ++i)
      dc += weights_[i] * dN[i] / sum * (points_[i] - c);
    return dc;
  }

  double SplineCurve::slope_of_distance(const Vec2 &x, const double t) const
  {
    return (value(t) - x) * derivative(t);
  }

  // The nearest of many points of the curve, then bisection between its neighbours.
  double SplineCurve::closest(const Vec2 &x) const
  {
    const unsigned int n_points = is_segment() ? 1 : 16 * n_spans();
    unsigned int       nearest  = 0;
    double             least    = (value(0.) - x).norm();
    for (unsigned int k = 1; k <= n_points; ++k)
      if (const double distance = (value(k / double(n_points)) - x).norm(); distance < least)
      {
        least   = distance;
        nearest = k;
      }
    double low  = nearest == 0 ? 0. : (nearest - 1) / double(n_points);
    double high = nearest == n_points ? 1. : (nearest + 1) / double(n_points);
    if (slope_of_distance(x, low) >= 0.)
      return low;
    if (slope_of_distance(x, high) <= 0.)
      return high;
    for (double middle = (low + high) / 2.; low < middle && middle < high; middle = (low + high) / 2.)
      (slope_of_distance(x, middle) < 0. ? low : high) = middle;
    return high;
  }
} // namespace retroforge
