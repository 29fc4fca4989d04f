// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/run/perturbed_design.h>
#include <retroforge/verification/difference_evaluator.h>

namespace retroforge
{
  DifferenceEvaluator make_difference_evaluator(const Case &forging_case, const ForwardRun &run)
  {
    DifferenceEvaluator differences;
    differences.free = [&forging_case, &run](const std::vector<double> &mu, const ShapePerturbation &shift) {
      ForgingProblem problem(
        forging_case, process_at(forging_case, mu, shift), positions_at(forging_case, mu, shift));
      if (forging_case.parameters.repeats_steps())
        problem.repeat_steps(run.strokes());
      Timings    timings;
      ForwardRun changed(std::move(problem), ForwardRun::Keep::nothing, timings);
      changed.forge();
      return forging_case.combine(changed.values());
    };
    differences.replayed = [&forging_case, &run](const std::vector<double> &mu,
                                                 const ShapePerturbation   &shift) {
      return forging_case.combine(
        run.replayed_values(process_at(forging_case, mu, shift), positions_at(forging_case, mu, shift)));
    };
    differences.tangent = [&forging_case, &run](const std::vector<double> &mu_dot,
                                                const ShapePerturbation   &shift_dot) {
      return directional_derivatives(forging_case, run, mu_dot, shift_dot);
    };
    return differences;
  }
} // namespace retroforge
