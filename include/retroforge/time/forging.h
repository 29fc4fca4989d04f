// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/steps/moved_ends.h>
#include <retroforge/time/increment_limits.h>

namespace retroforge
{
  class FollowingMesh;

  /// What is known at the end of an increment.
  struct IncrementEvent
  {
    const IncrementRecord      &record;
    const NodalVectors<double> &X_before; ///< on the mesh of the increment
    const SolvedIncrement      &solved;
    const ForgingState         &state; ///< after the increment
    double                      time;
    MovedEnds<double>           ends; ///< of the increment beside its record, in a replay
  };

  /// The time loop through the operations of a process: increments of equal stroke, as long as an accuracy
  /// bears, or those of another run, halved while an element would invert or a node would cross too much of an
  /// edge, on meshes that are remade when they must. In a replay what was recorded is obeyed instead.
  class Forging
  {
  public:
    using Observer     = std::function<void(const IncrementEvent &)>;
    using RecordAccess = std::function<const IncrementRecord &(unsigned int)>;

    /// What a replay that follows the trend must know of the recorded run.
    struct Nominal
    {
      const Process<double>      &process;
      const NodalVectors<double> &X_0;
      std::vector<FollowingRule>
        rules; ///< of each increment (steps/moved_ends.h), or none where ends are held
    };

    /// @param end  where the run goes: that of the process, or where other numerics begin to hold
    Forging(const ForgingModel    &model,
            const PressParameters &press,
            const StrokeStep      &end,
            const Remesher        &remesher,
            Timings               &timings);

    /// Before the first increment.
    static ForgingState
    start(std::shared_ptr<MeshEpoch> epoch, const Process<double> &process, const NodalVectors<double> &X_0);

    /// From `state` on other numerics hold: it goes on with whole increments of theirs.
    /// @param parameters  the complete input, which the next increment's record is to tell; none where the
    /// record need not
    static void change_numerics(std::optional<std::string> parameters, ForgingState &state);

    /// Returns whether increments are left before the end.
    bool is_left(const ForgingState &state) const;

    /// Goes on from `state` to the end, through all operations on the way, and decides everything anew.
    void run(const Process<double> &process, ForgingState &state, const Observer &observer) const;

    /// Where a run stood after n recorded increments, to the bit: nothing is solved.
    void restore(const Process<double> &process,
                 unsigned int           n,
                 const RecordAccess    &access,
                 ForgingState          &state,
                 const Observer        &observer) const;

    /// Obeys the decisions of n recorded increments, and starts each solve from the recorded one.
    /// @param nominal  the recorded run, where new meshes follow the shape, and ends of increments the state; null: both
    /// are held
    void replay(const Process<double> &process,
                const Nominal         *nominal,
                unsigned int           n,
                const RecordAccess    &access,
                ForgingState          &state,
                const Observer        &observer = {}) const;

    /// Takes the state to another mesh as recorded: the workpiece by the step steps/change_of_mesh.h.
    /// @param dies  at its stroke
    /// @param following  the new mesh, where it follows the shape; null: it is held
    void change_mesh(const std::vector<DieState<double>> &dies,
                     const RemeshRecord                  &remesh,
                     ForgingState                        &state,
                     const FollowingMesh                 *following = nullptr) const;

  private:
    /// Takes the state to the start of an operation, unless it is in it: other dies, which have not met the
    /// workpiece, and whole increments again.
    void enter(unsigned int operation, ForgingState &state) const;

    /// Returns how far the operation of the state goes, by the end at most [mm].
    double last_stroke(const Process<double> &process, const ForgingState &state) const;

    /// Solves an increment of record.step, and returns why it is rejected, if it is.
    /// @param guess  out: what was found, for a shorter increment
    std::optional<StepRejection> attempt(const Process<double> &process,
                                         const ForgingState    &state,
                                         InitialGuess          &guess,
                                         IncrementRecord       &record,
                                         SolvedIncrement       &solved) const;
    void remesh(const Process<double> &process, ForgingState &state, IncrementRecord &record) const;
    /// What the last solution's errors ask for; empty where sizes do not follow them, or nothing is solved.
    std::optional<OptimalSizes> error_sizes(const Process<double> &process, const ForgingState &state) const;
    /// Takes the state to the increment's end, and tells `observer`.
    void finish_increment(const Process<double>   &process,
                          const IncrementRecord   &record,
                          const SolvedIncrement   &solved,
                          ForgingState            &state,
                          const Observer          &observer,
                          const MovedEnds<double> &ends = {}) const;

    /// Returns the next increment's length, before anything is known of it [mm].
    /// @param cuts  out: how often it is half of one that is to be repeated
    double next_step(const Process<double> &process, const ForgingState &state, unsigned int &cuts) const;
    /// Returns that of one that is to be repeated, or of a part of it.
    double repeated_step(const Process<double> &process, const ForgingState &state, unsigned int &cuts) const;
    /// Returns whether an increment is good enough: one that is to be repeated is kept where one that is chosen
    /// would be shorter.
    bool is_good(const std::optional<StepRejection> &rejection) const
    {
      return !rejection || (!steps_.empty() && rejection->is_bearable);
    }

    /// Chooses how often the next increment is halved, after one of last_step [mm].
    /// @param left  stroke to the end of the operation [mm]
    void choose_depth(double last_step, double left, ForgingState &state) const;
    /// Returns whether a first increment, of which nothing was known, strains the metal too much.
    std::optional<StepRejection> too_strained(const Process<double> &process,
                                              const ForgingState    &state,
                                              const SolvedIncrement &solved,
                                              const IncrementRecord &record) const;

    /// Stroke of an increment that is not cut [mm].
    double nominal_step() const { return model_.step.contact.step; }

    const ForgingModel   &model_;
    const GivenSteps     &steps_; ///< that are repeated
    const StrokeStep      end_;
    const Remesher       &remesher_;
    Timings              &timings_;
    const IncrementLimits limits_;
  };
} // namespace retroforge
