// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/run/forward_run.h>
#include <retroforge/run/perturbed_design.h>
#include <retroforge/verification/difference_evaluator.h>

namespace retroforge
{
  DifferenceEvaluator
  make_difference_evaluator(const Case &forging_case, const Forging &forging, const RecordedForging &recorded)
  {
    DifferenceEvaluator differences;
    differences.free = [&forging_case](const std::vector<double> &mu, const ShapePerturbation &shift) {
      ForwardRun trial(forging_case,
                       process_at(forging_case, mu, shift),
                       positions_at(forging_case, mu, shift),
                       ForwardRun::Keep::nothing);
      trial.forge();
      return forging_case.combine(trial.values());
    };
    differences.replayed = [&forging_case, &forging, recorded](const std::vector<double> &mu,
                                                               const ShapePerturbation   &shift) {
      const Process<double> process = process_at(forging_case, mu, shift);
      ObjectiveTrace        trace(forging_case.objectives, process, recorded.traced.decisions);
      ForgingState          state = forging.start(recorded.first, positions_at(forging_case, mu, shift));
      forging.replay(
        process, recorded.n, recorded.source, state, [&](const IncrementEvent &event) { trace.add(event); });
      return forging_case.combine(trace.values(state));
    };
    differences.tangent = [&forging_case, recorded](const std::vector<double> &mu_dot,
                                                    const ShapePerturbation   &shift_dot) {
      return directional_derivatives(forging_case, recorded, mu_dot, shift_dot);
    };
    return differences;
  }
} // namespace retroforge
