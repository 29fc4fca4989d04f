// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/types.h>

#include <vector>

namespace retroforge
{
  /// The cubic p through a value at the origin that is closest to values around it,
  ///   sum_b w_b ( q_b - p(d_b) )^2 + eps_2 |H_2|^2 + eps_3 |H_3|^2  ->  min,    w_b = 1/|d_b|^4,
  ///   p(d) = q_0 + g·d + H_2(d) + H_3(d),
  /// H_2 and H_3 the coefficients of second and third order: the coefficients c_b of
  ///   g·direction = sum_b c_b (q_b - q_0),
  /// and their derivatives in points and direction.
  /// Exact for linear fields however few points there are. With fewer points than unknowns, as usual, terms
  /// of second order explain what they can (eps_2 is much smaller than eps_3), and those of third order the
  /// rest.
  ///
  /// Measured by the loss of a Gaussian over 60 local remeshings: a quadratic loses 1.25 times as much, with
  /// the weights 1/|d_b|^2 1.34 times, and with twice as many points around 1.6 times: it is more to the
  /// point to fit what is near than to average.
  template <typename Number>
  class GradientFit
  {
  public:
    /// @param points     d_b [mm]; only the first n components count
    /// @param n          1 on a line, 2 on a plane, 3 in space
    GradientFit(const std::vector<Vector3<Number>> &points, unsigned int n);

    /// Returns whether the points span the n dimensions: without that there are no coefficients.
    bool is_determined() const { return !factor_.empty(); }

    /// Returns c_b.  @param direction  [mm]
    std::vector<Number> coefficients(const Vector3<Number> &direction) const;

    /// Adds the pull-back of c_bar through coefficients(direction) to points_bar and direction_bar; on double. Of
    /// equally far points, and of equally large entries of the normal matrix, the first is the one that follows.
    void reverse(const Vec3                &direction,
                 const std::vector<double> &c_bar,
                 std::vector<Vec3>         &points_bar,
                 Vec3                      &direction_bar) const;

  private:
    void                factorise(Number largest);
    std::vector<Number> solved(std::vector<Number> x) const;
    /// Returns z with  c_b = w_b z·m(d_b),  m the monomials.
    std::vector<Number> solution(const Vector3<Number> &direction, std::vector<Number> &coefficients) const;

    unsigned int                 n_, n_third_, first_, size_; ///< dimensions; monomials of third order, above the first, all
    std::vector<Vector3<Number>> points_;                     ///< d_b/|d|_max
    std::vector<Number>          weights_;                    ///< w_b, of these
    Number                       longest_;                    ///< |d|_max [mm]
    std::size_t                  farthest_ = 0;               ///< the point of it
    unsigned int                 dominant_ = 0;               ///< row of the largest entry
    std::vector<Number>          factor_;                     ///< Cholesky's, row by row; empty: undetermined
  };

  template <>
  void GradientFit<double>::reverse(const Vec3                &direction,
                                    const std::vector<double> &c_bar,
                                    std::vector<Vec3>         &points_bar,
                                    Vec3                      &direction_bar) const;
} // namespace retroforge
