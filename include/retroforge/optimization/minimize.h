// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/optimization/linear_relation.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace retroforge
{
  /// A function of a few scaled variables between bounds, with linear relations, known by its values and its
  /// gradients.
  struct BoundedProblem
  {
    using Vector = std::vector<double>;

    Vector start, lower, upper; ///< bounds may be infinite
    /// lower <= weights . x <= upper,  with weights of length 1; points that are tried keep them.
    std::vector<LinearRelation> relations;

    /// +infinity where there is none: never NaN, and nothing is thrown.
    std::function<double(const Vector &x)> value;
    /// At a point whose value was finite.
    std::function<Vector(const Vector &x)> gradient;
    /// Returns the known part of the Hessian times v, at the point of the last gradient; null: nothing is
    /// known.
    std::function<Vector(const Vector &v)> known_hessian;
    bool                                   known_is_all = false; ///< else the rest is learned
    /// A point that was tried becomes the next one, or is refused: called after its value.
    std::function<void(const Vector &x, bool accepted)> decided;
  };

  /// A derivative along a direction, and its central difference.
  struct DifferenceCheck
  {
    double step, derivative, difference, error; ///< error: absolute, of the last two
  };

  /// At the start of a problem, by ROL's check of objectives.
  std::vector<DifferenceCheck> check_derivative(const BoundedProblem         &problem,
                                                const BoundedProblem::Vector &direction,
                                                const std::vector<double>    &steps);

  /// State of a minimisation.
  struct MinimizerState
  {
    unsigned int iteration = 0; ///< points tried
    double       value     = 0.;
    double       gradient  = 0.; ///< length of  P(x - g) - x,  with P onto bounds and relations
    double       radius    = 0.; ///< radius of the trust region
  };

  struct MinimizerSettings
  {
    double first_radius   = 1.;
    double largest_radius = 4.;
    /// Noise of the values, which is added to both reductions before they are compared.
    double noise = 0.;
    /// Asked before each iteration; the minimisation ends where it says false.
    std::function<bool(const MinimizerState &)> go_on;
  };

  /// Trust region by Lin and Moré, from ROL of Trilinos: each iteration takes one value, and each that is
  /// accepted one gradient. A trust region refuses a point of infinite value, and goes on with a quarter of
  /// the step. What of the Hessian is not known is learned from gradients, by limited-memory BFGS of ten
  /// pairs, and kept from one minimisation to the next: functions may differ by their known parts.
  class Minimizer
  {
  public:
    Minimizer();
    ~Minimizer();

    /// @return the last point that was accepted
    BoundedProblem::Vector minimize(const BoundedProblem &problem, const MinimizerSettings &settings);

  private:
    struct Learned;
    const std::unique_ptr<Learned> learned_;
  };
} // namespace retroforge
