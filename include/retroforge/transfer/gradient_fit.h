// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/types.h>

#include <vector>

namespace retroforge
{
  /// The cubic p through a value at the origin that is closest to values around it,
  ///   sum_b w_b ( q_b - p(d_b) )^2 + eps_2 |H_2|^2 + eps_3 |H_3|^2  ->  min,    w_b = 1/(|d_b|^4 + 1e-12),
  ///   p(d) = q_0 + g·d + H_2(d,d) + H_3(d,d,d),
  /// H_2 and H_3 symmetric tensors, |H|^2 the sum of the squares of all their components: the coefficients c_b of
  ///   g·direction = sum_b c_b (q_b - q_0),
  /// and their derivatives in points and direction. Lengths are over the root of twice the mean of |d_b|^2. Nothing is
  /// chosen by size, and axes do not matter, so that coefficients are smooth functions of the points.
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

    /// Adds the pull-back of c_bar through coefficients(direction) to points_bar and direction_bar; on double.
    void reverse(const Vec3                &direction,
                 const std::vector<double> &c_bar,
                 std::vector<Vec3>         &points_bar,
                 Vec3                      &direction_bar) const;

  private:
    void factorise();
    /// eps of unknown i: what is added to the normal matrix there, over `scale_`.
    double              damping(unsigned int i) const;
    std::vector<Number> solved(std::vector<Number> x) const;
    /// Returns z with  c_b = w_b z·m(d_b),  m the monomials.
    std::vector<Number> solution(const Vector3<Number> &direction, std::vector<Number> &coefficients) const;

    unsigned int n_, n_third_, first_, size_; ///< dimensions; monomials of third order, above the first, all
    Number       unit_;                       ///< of length [mm]
    std::vector<Vector3<Number>> points_;     ///< d_b over it
    std::vector<Number>          weights_;    ///< w_b, of these
    Number                       scale_;      ///< sum_b w_b |d_b|^2/n of these, the size of the matrix
    std::vector<Number>          factor_;     ///< Cholesky's, row by row; empty: undetermined
  };

  template <>
  void GradientFit<double>::reverse(const Vec3                &direction,
                                    const std::vector<double> &c_bar,
                                    std::vector<Vec3>         &points_bar,
                                    Vec3                      &direction_bar) const;
} // namespace retroforge
