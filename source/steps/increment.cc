// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/steps/history.h>
#include <retroforge/steps/increment.h>

namespace retroforge
{
  bool Increment::reads_history(const Process<double> &process)
  {
    return process.material.depends_on_state();
  }

  void Increment::advance(const SolvedIncrement &solved, WorkpieceState<3, double> &state) const
  {
    for (const auto &stage : solved.stages)
      add_history(stage->view(), solved.start->dt, state);
    state.X        = solved.X;
    state.velocity = solved.velocity;
  }

  void Increment::tangent(const Process<Dual>     &process,
                          const IncrementRecord   &record,
                          const TangentObserver   &observer,
                          WorkpieceState<3, Dual> &state)
  {
    WorkpieceState<3, Dual> next = state;
    next.X =
      mechanics.tangent(process, state, record, [&](const EquilibriumView<Dual> &view, const Dual &dt) {
        observer(view, dt);
        add_history(view, dt, next);
      });
    const Dual dt = process.duration(place(record));
    next.velocity.resize(next.X.size());
    for (std::size_t k = 0; k < next.X.size(); ++k)
      next.velocity[k] = (next.X[k] - state.X[k]) / dt;
    state = std::move(next);
  }

  void Increment::reverse(const Process<double>           &process,
                          const WorkpieceState<3, double> &state,
                          const IncrementRecord           &record,
                          const AdjointSource             &source,
                          std::vector<Costate>            &costates)
  {
    const double dt = process.duration(place(record));
    mechanics.reverse(
      process,
      state,
      record,
      [&](const std::size_t j, const EquilibriumView<double> &view, EquilibriumBar &bar) {
        source(j, view, bar);
        reverse_history(view, dt, costates[j].workpiece, bar);
      },
      costates);
  }
} // namespace retroforge
