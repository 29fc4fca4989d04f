// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/optimization/bounded_problem.h>

namespace retroforge
{
  /// A function near a point where it is linearised:  g.s + s.B s / 2  and each term of its linearised value, so
  /// that limits press where they do, and not all the way or nowhere.
  class LocalModel
  {
  public:
    using Vector  = BoundedProblem::Vector;
    using Hessian = std::function<Vector(const Vector &v)>; ///< B; null: 0

    LocalModel(const Vector &origin, Linearization known, Hessian hessian);

    /// Returns the same one with more terms.
    LocalModel with(const std::vector<PenaltyTerm> &terms) const;

    const Vector &origin() const { return origin_; }
    /// m(x) - m(origin).
    double change(const Vector &x) const;
    Vector gradient(const Vector &x) const;
    /// The second derivative at x times v; at kinks that of one side.
    Vector bend(const Vector &x, const Vector &v) const;

    /// A curvature that is large against what the model bends along a direction.
    /// @param direction  of length 1
    double stiff_against(const Vector &direction) const;

  private:
    Vector        origin_;
    Linearization known_;
    Hessian       hessian_;
  };

  /// Where a model is least between bounds and within relations, no variable farther from its origin than a
  /// radius: a local minimum, where it bends downwards. By the method of Lin and Moré, from ROL; relations by an
  /// augmented Lagrangian, to 1e-12.
  /// @param tolerance  of the model's projected gradient there
  BoundedProblem::Vector
  least_of(const LocalModel &model, const BoundedProblem &problem, double radius, double tolerance);

  /// A derivative along a direction, and its central difference.
  struct DifferenceCheck
  {
    double step, derivative, difference, error; ///< error: absolute, of the last two
  };

  /// At the start of a problem, by ROL's check of objectives.
  std::vector<DifferenceCheck> check_derivative(const BoundedProblem         &problem,
                                                const BoundedProblem::Vector &direction,
                                                const std::vector<double>    &steps);
} // namespace retroforge
