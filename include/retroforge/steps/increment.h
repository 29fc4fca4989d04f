// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/steps/heating.h>

#include <optional>

namespace retroforge
{
  /// What the way back needs of an increment's history and does not find in its record, without motion.
  struct IncrementMemory
  {
    KeptState start; ///< the state at its start
    // Where heat flows.
    WorkpieceState<3, double> half;   ///< as the stages of mechanics find it, without skins
    KeptState                 worked; ///< after mechanics and history, before the second half
    TouchedDies               touching;
  };

  /// One increment of time as the list of its steps: heat that flows for half of it (steps/heating.h); mechanics,
  /// which is solved; history, which follows from its stages; and heat for the other half. Each step has its forward,
  /// tangent and reverse in files of its own.
  class Increment
  {
  public:
    Increment(const Scene            &scene,
              const StepModel        &model,
              const NewtonParameters &newton,
              LinearSystem           &system,
              Timings                &timings)
        : mechanics(scene, model, newton, system, timings), scene_(scene), timings_(timings)
    {
    }

    /// Tells whether reverse() reads more of the state at the start than its positions and velocity.
    static bool reads_history(const Process<double> &process);

    /// Solves the increment from a state: as Mechanics::forward().
    SolvedIncrement forward(const Process<double>           &process,
                            const WorkpieceState<3, double> &state,
                            bool                             replay,
                            const InitialGuess              &guess,
                            IncrementRecord                 &record);

    /// Returns the same from what was recorded, to the bit: no equilibrium is solved.
    SolvedIncrement recorded(const Process<double>           &process,
                             const WorkpieceState<3, double> &state,
                             const IncrementRecord           &record) const;

    /// Takes the state to the end of a solved increment.
    /// @return what reverse() asks for; nothing unless it reads_history()
    IncrementMemory advance(const Process<double>     &process,
                            const SolvedIncrement     &solved,
                            const IncrementRecord     &record,
                            WorkpieceState<3, double> &state) const;

    /// Takes the derivative of the state along (state, process) to the end of a recorded increment.
    /// @param observer  is called after each stage
    void tangent(const Process<Dual>     &process,
                 const IncrementRecord   &record,
                 const TangentObserver   &observer,
                 WorkpieceState<3, Dual> &state);

    /// Takes costates from the end of a recorded increment to its start.
    /// @param state   at the start; all but motion may be missing unless reads_history()
    /// @param memory  what advance() returned
    /// @param source  what objectives take from each stage
    void reverse(const Process<double>           &process,
                 const WorkpieceState<3, double> &state,
                 const IncrementMemory           &memory,
                 const IncrementRecord           &record,
                 const AdjointSource             &source,
                 std::vector<Costate>            &costates);

    Mechanics mechanics; ///< what it shares with replays and restarts is its own

  private:
    /// Of the mesh, found when heat first flows.
    const NetworkEdges &edges() const;

    /// Solves mechanics from the state as its stages find it: `solve(state)`.
    template <typename Solve>
    SolvedIncrement after_first_half(const Process<double>           &process,
                                     const WorkpieceState<3, double> &state,
                                     const IncrementRecord           &record,
                                     const Solve                     &solve) const;

    const Scene                        &scene_;
    Timings                            &timings_;
    mutable std::optional<NetworkEdges> edges_;
  };
} // namespace retroforge
