// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/run/perturbed_design.h>
#include <retroforge/run/trial.h>
#include <retroforge/verification/difference_oracle.h>

namespace retroforge
{
  ObjectiveOracle make_oracle(const Case &at, const Forging &forging, const RecordedForging &recorded)
  {
    ObjectiveOracle oracle;
    oracle.free = [&at](const std::vector<double> &mu, const FreeForm &shift) {
      Trial trial(at, process_at(at, mu, shift), positions_at(at, mu, shift), Trial::Keep::nothing);
      trial.forge();
      return at.combine(trial.values());
    };
    oracle.replayed = [&at, &forging, recorded](const std::vector<double> &mu, const FreeForm &shift) {
      const Process<double> process = process_at(at, mu, shift);
      ObjectiveTrace        trace(at.objectives, at.model, process);
      ForgingState          state = forging.start(recorded.first, positions_at(at, mu, shift));
      forging.replay(
        process, recorded.n, recorded.source, state, [&](const IncrementEvent &event) { trace.add(event); });
      return at.combine(trace.values(state, false));
    };
    oracle.tangent = [&at, recorded](const std::vector<double> &mu_dot, const FreeForm &shift_dot) {
      return directional_derivatives(at, recorded, mu_dot, shift_dot);
    };
    return oracle;
  }
} // namespace retroforge
