// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/optimization/optimization_problem.h>

#include <functional>

namespace retroforge
{
  struct Noise
  {
    double              objective = 0.; ///< in its unit
    std::vector<double> values;         ///< of each value of the problem, in its unit
    unsigned int        n_designs = 0;  ///< that it is the mean of
  };

  /// Returns the values at a design as the gradients at another predict them.
  std::vector<double> predicted_values(const Evaluation &from, const std::vector<double> &mu);

  /// Measures the noise of the objective and of all values: forges a few designs around another (Optimisation/noise runs),
  /// over steps so short that all they add to what the gradient predicts is what decisions of the program
  /// change,
  ///   noise = sqrt(mean (phi(mu) - phi_linear(mu))^2).
  /// @param at    that design, with gradients
  /// @param tell  gets each design that was forged, and its largest distance from there, in scales
  Noise measure_noise(OptimizationProblem                                             &problem,
                      const Evaluation                                                &at,
                      const std::function<void(const Evaluation &evaluation, double)> &tell);
} // namespace retroforge
