// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/steps/history.h>
#include <retroforge/steps/increment.h>

namespace retroforge
{
  namespace
  {
    /// The mechanics of an increment make another one.
    template <typename Number>
    void forget(NodeField<Number> &friction_flux)
    {
      std::fill(friction_flux.begin(), friction_flux.end(), Number(0.));
    }
  } // namespace

  bool Increment::reads_history(const Process<double> &process)
  {
    return process.material.depends_on_state() || process.heat.conducts();
  }

  const NetworkEdges &Increment::edges() const
  {
    if (!edges_)
      edges_.emplace(scene_.mesh, scene_.topology);
    return *edges_;
  }

  template <typename Solve>
  SolvedIncrement Increment::after_first_half(const Process<double>           &process,
                                              const WorkpieceState<3, double> &state,
                                              const IncrementRecord           &record,
                                              const Solve                     &solve) const
  {
    if (!process.heat.conducts())
      return solve(state);
    WorkpieceState<3, double> half = state;
    ThermalSurface<double>    touching;
    {
      const auto timing = timings_.scope("heat");
      touching          = conduct_before(scene_, edges(), process, place(record), half);
    }
    SolvedIncrement solved = solve(half);
    solved.before          = without_motion(std::move(half));
    solved.touching        = std::move(touching);
    return solved;
  }

  SolvedIncrement Increment::forward(const Process<double>           &process,
                                     const WorkpieceState<3, double> &state,
                                     const bool                       replay,
                                     const InitialGuess              &guess,
                                     IncrementRecord                 &record)
  {
    return after_first_half(process, state, record, [&](const WorkpieceState<3, double> &at) {
      return mechanics.forward(process, at, replay, guess, record);
    });
  }

  SolvedIncrement Increment::recorded(const Process<double>           &process,
                                      const WorkpieceState<3, double> &state,
                                      const IncrementRecord           &record) const
  {
    return after_first_half(process, state, record, [&](const WorkpieceState<3, double> &at) {
      return mechanics.recorded(process, at, record);
    });
  }

  IncrementMemory Increment::advance(const Process<double>     &process,
                                     const SolvedIncrement     &solved,
                                     const IncrementRecord     &record,
                                     WorkpieceState<3, double> &state) const
  {
    IncrementMemory memory;
    if (reads_history(process))
      memory.start = KeptState(state);
    if (solved.before)
    {
      state = memory.half       = *solved.before;
      memory.half.skin          = {}; // mechanics reads none, and leaves it to the second half
      memory.half.friction_flux = {};
      forget(state.friction_flux);
    }
    for (const auto &stage : solved.stages)
      add_history(stage->view(), solved.start->dt, state);
    if (process.heat.conducts())
    {
      const auto timing = timings_.scope("heat");
      memory.worked     = KeptState(state);
      memory.touching   = {
          solved.touching,
          conduct_after(solved.touching, scene_, edges(), process, place(record), solved.X, state)};
    }
    state.X        = solved.X;
    state.velocity = solved.velocity;
    return memory;
  }

  void Increment::tangent(const Process<Dual>     &process,
                          const IncrementRecord   &record,
                          const TangentObserver   &observer,
                          WorkpieceState<3, Dual> &state)
  {
    ThermalSurface<Dual> touching;
    if (process.heat.conducts())
      touching = conduct_before(scene_, edges(), process, place(record), state);
    WorkpieceState<3, Dual> next = state;
    forget(next.friction_flux);
    next.X =
      mechanics.tangent(process, state, record, [&](const EquilibriumView<Dual> &view, const Dual &dt) {
        observer(view, dt);
        add_history(view, dt, next);
      });
    const Dual dt = process.duration(place(record));
    next.velocity.resize(next.X.size());
    for (std::size_t k = 0; k < next.X.size(); ++k)
      next.velocity[k] = (next.X[k] - state.X[k]) / dt;
    if (process.heat.conducts())
      conduct_after(touching, scene_, edges(), process, place(record), next.X, next);
    state = std::move(next);
  }

  void Increment::reverse(const Process<double>           &process,
                          const WorkpieceState<3, double> &state,
                          const IncrementMemory           &memory,
                          const IncrementRecord           &record,
                          const AdjointSource             &source,
                          std::vector<Costate>            &costates)
  {
    const double                        dt = process.duration(place(record));
    WorkpieceState<3, double>           half;
    std::optional<ReversibleConduction> conduction;
    if (process.heat.conducts())
    {
      const auto timing = timings_.scope("heat");
      conduction.emplace(scene_, edges(), process, place(record), state, memory.touching);
      NodalVectors<double>       X = state.X;
      const NodalVectors<double> v = mechanics.mean_velocity(record);
      for (std::size_t k = 0; k < X.size(); ++k)
        X[k] += dt * v[k];
      conduction->reverse_after(X, memory.worked.get(), costates);
      half          = memory.half;
      half.X        = state.X;
      half.velocity = state.velocity;
    }
    mechanics.reverse(
      process,
      conduction ? half : state,
      record,
      [&](const std::size_t j, const EquilibriumView<double> &view, EquilibriumBar &bar) {
        source(j, view, bar);
        reverse_history(view, dt, costates[j].workpiece, bar);
      },
      costates);
    if (conduction)
    {
      const auto timing = timings_.scope("heat");
      for (Costate &costate : costates)
        forget(costate.workpiece.friction_flux);
      conduction->reverse_before(costates);
    }
  }
} // namespace retroforge
