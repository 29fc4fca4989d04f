// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/steps/mechanics.h>

namespace retroforge
{
  /// One increment of time as the list of its steps: mechanics, which is solved, and history, which follows
  /// from its stages. Each step has its forward, tangent and reverse in files of its own; a step that comes
  /// to them, as heat, is called here.
  class Increment
  {
  public:
    Increment(const Scene            &scene,
              const StepModel        &model,
              const NewtonParameters &newton,
              LinearSystem           &system,
              Timings                &timings)
        : mechanics(scene, model, newton, system, timings), scene_(scene)
    {
    }

    /// Tells whether reverse() reads more of the state at the start than its positions and velocity.
    static bool reads_history(const Process<double> &process);

    /// Takes the state to the end of an increment whose mechanics is solved.
    void advance(const SolvedIncrement &solved, WorkpieceState<3, double> &state) const;

    /// Takes the derivative of the state along (state, process) to the end of a recorded increment.
    /// @param observer  is called after each stage
    void tangent(const Process<Dual>     &process,
                 const IncrementRecord   &record,
                 const TangentObserver   &observer,
                 WorkpieceState<3, Dual> &state);

    /// Takes costates from the end of a recorded increment to its start.
    /// @param state   at the start; all but these may be missing unless reads_history()
    /// @param source  what objectives take from each stage
    void reverse(const Process<double>           &process,
                 const WorkpieceState<3, double> &state,
                 const IncrementRecord           &record,
                 const AdjointSource             &source,
                 std::vector<Costate>            &costates);

    Mechanics mechanics; ///< forward(), recorded() and replays are its own

  private:
    const Scene &scene_;
  };
} // namespace retroforge
