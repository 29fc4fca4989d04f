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
  };

  /// Measures the noise of the objective and of all values: forges a few designs around the start (Optimisation/noise runs),
  /// over steps so short that all they add to what the gradient predicts is what decisions of the program
  /// change,
  ///   noise = sqrt(mean (phi(mu) - phi_linear(mu))^2).
  /// @param start  with gradients
  /// @param tell   gets each design that was forged, and its largest distance from the start, in scales
  /// @return 0 where no design was forged
  Noise measure_noise(OptimizationProblem                                             &problem,
                      const Evaluation                                                &start,
                      const std::function<void(const Evaluation &evaluation, double)> &tell);
} // namespace retroforge
