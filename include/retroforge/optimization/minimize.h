// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/optimization/bounded_problem.h>
#include <retroforge/optimization/secant_hessian.h>

namespace retroforge
{
  /// State of a minimisation.
  struct MinimizerState
  {
    unsigned int iteration = 0; ///< points tried
    double       value     = 0.;
    double       gradient  = 0.; ///< length of  P(x - g) - x,  with P onto bounds and relations
    double       radius    = 0.; ///< radius of the trust region
    double       promised  = 0.; ///< by the model, of the next step
  };

  struct MinimizerSettings
  {
    double first_radius   = 1.;
    double largest_radius = 4.;
    /// Asked before each iteration; the minimisation ends where it says false.
    std::function<bool(const MinimizerState &)> go_on;
  };

  /// A trust region whose model keeps terms as they are: the smooth part's gradient, what was learned of its
  /// Hessian, and each term of its linearised value. So a step knows where limits begin to press before it is
  /// tried. The region is a box. Each iteration takes one value, and each that is accepted one linearisation,
  /// whose noise is added to both reductions before they are compared; a point of infinite value is refused.
  /// What is learned is kept from one minimisation to the next: functions may differ by their terms.
  /// @cite Conn, Gould and Toint 2000, sections 6.1 and 11.4
  class Minimizer
  {
  public:
    /// @return the last point that was accepted
    BoundedProblem::Vector minimize(const BoundedProblem &problem, const MinimizerSettings &settings);

  private:
    SecantHessian learned_;
  };
} // namespace retroforge
