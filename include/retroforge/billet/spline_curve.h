// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/tensor.h>

#include <vector>

namespace retroforge
{
  /// A point or vector of the meridian plane, components r and z.
  using Vec2 = dealii::Tensor<1, 2>;

  /// a_r b_z - a_z b_r: positive when b lies to the left of a, seen with r to the right and z upwards.
  double cross(const Vec2 &a, const Vec2 &b);

  /// Clamped rational B-spline of the meridian plane with equally spaced inner knots,
  ///   c(t) = sum_i R_i(t) P_i,  R_i = w_i N_i / sum_j w_j N_j,  0 <= t <= 1,
  /// which begins at the first control point and ends at the last. With two points it is their segment.
  class SplineCurve
  {
  public:
    /// @param weights  one for each point, > 0; none for a polynomial spline
    SplineCurve(const std::vector<Vec2>   &control_points,
                unsigned int               degree,
                const std::vector<double> &weights = {});

    /// The values R_i(t) at all control points; their sum is one.
    std::vector<double> basis(double t) const;
    Vec2                value(double t) const;
    Vec2                derivative(double t) const; ///< dc/dt

    /// Parameter of the point of the curve closest to x, to rounding.
    double closest(const Vec2 &x) const;

    bool                       is_segment() const { return points_.size() == 2; }
    unsigned int               n_spans() const { return points_.size() - degree_; }
    unsigned int               degree() const { return degree_; }
    const std::vector<Vec2>   &control_points() const { return points_; }
    const std::vector<double> &weights() const { return weights_; }

  private:
    double              knot(int i) const;
    std::vector<double> polynomial_basis(double t, unsigned int degree) const;
    std::vector<double> polynomial_basis_derivative(double t) const;
    double              slope_of_distance(const Vec2 &x, double t) const;

    std::vector<Vec2>   points_;
    unsigned int        degree_;
    std::vector<double> weights_;
  };
} // namespace retroforge
