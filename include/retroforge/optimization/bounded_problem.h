// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/optimization/linear_relation.h>

#include <functional>
#include <vector>

namespace retroforge
{
  /// A function of one value c that is known by its linearisation:  lambda c + rho c^2 / 2,  or a limit's
  /// ([lambda + rho c]_+^2 - lambda^2) / (2 rho),  which has a kink in its slope where the limit begins to press.
  struct PenaltyTerm
  {
    double              c = 0.;          ///< at the point of linearisation
    std::vector<double> gradient;        ///< of c
    double              curvature  = 1.; ///< rho
    bool                is_limit   = false;
    double              multiplier = 0.; ///< lambda

    double value(double at_c) const;
    double slope(double at_c) const;
    double bend(double at_c) const; ///< second derivative
  };

  /// What is known of a function at a point: it is a smooth one plus terms.
  struct Linearization
  {
    std::vector<double>      gradient; ///< of the smooth one
    std::vector<PenaltyTerm> terms;
    double                   noise = 0.; ///< of the value

    /// Returns the gradient of both together.
    std::vector<double> whole_gradient() const;
  };

  /// A function of a few scaled variables between bounds, with linear relations, known by its values and its
  /// linearisations.
  struct BoundedProblem
  {
    using Vector = std::vector<double>;

    Vector start, lower, upper; ///< bounds may be infinite
    /// lower <= weights . x <= upper,  with weights of length 1; points that are tried keep them.
    std::vector<LinearRelation> relations;

    /// +infinity where there is none: never NaN, and nothing is thrown.
    std::function<double(const Vector &x)> value;
    /// At a point whose value was finite.
    std::function<Linearization(const Vector &x)> linearize;
    /// Whether what bends beside the terms is learned; else there is nothing.
    bool learns = true;
    /// A point that was tried becomes the next one, or is refused: called after its value.
    std::function<void(const Vector &x, bool accepted)> decided;
  };
} // namespace retroforge
