// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/rank_sum.h>
#include <retroforge/heat/thermal_surface.h>
#include <retroforge/record/increment_record.h>
#include <retroforge/solver/newton.h>
#include <retroforge/solver/spent_power.h>
#include <retroforge/steps/history.h>
#include <retroforge/steps/process.h>
#include <retroforge/steps/scheme.h>
#include <retroforge/steps/workpiece_state.h>

namespace retroforge
{
  /// What of a scene's numerical model is neither mesh nor process. Of a recorded increment, scheme and
  /// contact are those of the record.
  struct StepModel
  {
    Scheme           scheme = Scheme::all().front();
    ContactNumerics  contact;
    bool             edges_touch       = true;  ///< middles of edges are contact points of curved dies
    bool             holds_loose       = true;  ///< what dies leave loose is held (RigidHold)
    double           reach             = 0.;    ///< nodes nearer than this to a die are watched [mm]
    double           adjoint_tolerance = 1e-10; ///< of the adjoint and tangent linear systems
    ShapeDerivatives shape_derivatives;         ///< of the backward sweep
  };

  /// What flows backwards through a run for one scalar Phi.
  struct Costate
  {
    WorkpieceState<3, double> workpiece; ///< derivatives in it, complete on every rank
    RankSum<Process<double>>  process;
  };

  /// Adds what costate j's Phi takes from a stage of the increment, this rank's part.
  using AdjointSource = std::function<void(std::size_t j, const EquilibriumView<double> &, EquilibriumBar &)>;

  /// Observer of a tangent: called after each stage that integrals weigh, with the increment's time dt.
  using TangentObserver = std::function<void(const EquilibriumView<Dual> &, const Dual &)>;

  /// What the stages of an increment share, as found at its start.
  template <typename Number>
  struct IncrementStart
  {
    Physics<Number>      physics;
    Number               dt; ///< [s]
    ContactSet<Number>   contact;
    StageHistory<Number> history;

    IncrementStart(const Scene                     &scene,
                   const Process<Number>           &process,
                   const WorkpieceState<3, Number> &state,
                   const IncrementRecord           &record);
  };

  /// A stage in equilibrium, with what its view refers to. Bubbles are recovered from nothing, so that a
  /// resumed run has the same bits, or from others near them, which takes about half as long and changes them
  /// by rounding.
  struct SolvedStage
  {
    const NodalVectors<double> X;
    const ActiveSet            active;
    const double               weight; ///< b_s of the scheme
    const Equilibrium<double>  stage;
    Field<double>              W;

    SolvedStage(const Scene                  &scene,
                const IncrementStart<double> &start,
                unsigned int                  s,
                NodalVectors<double>          X,
                const SolveRecord            &solve,
                double                        weight,
                const NodeVector<3, double>  &bubbles = {});
    SolvedStage(const SolvedStage &) = delete; // its members refer to each other

    EquilibriumView<double> view() const { return {stage, W, active, weight}; }
  };

  /// An increment when it is done: the stages that integrals weigh, and where it leads to.
  struct SolvedIncrement
  {
    std::shared_ptr<const IncrementStart<double>>   start;
    std::vector<std::shared_ptr<const SolvedStage>> stages;
    NodalVectors<double>                            X;
    NodalVectors<double>                            velocity; ///< of the nodes, its mean [mm/s]
    /// The state as its stages found it, without motion, where that is not the one at its start.
    std::optional<WorkpieceState<3, double>> before = {};
    /// What touched its dies in the first half of its heat, where that flows.
    ThermalSurface<double> touching = {};

    const SolvedStage &last() const { return *stages.back(); }
  };

  /// The step of an increment that is solved: the equilibrium of each stage of the scheme, and the motion of
  /// the nodes that follows; forward, its tangent, and its reverse.
  class Mechanics
  {
  public:
    Mechanics(const Scene            &scene,
              const StepModel        &model,
              const NewtonParameters &newton,
              LinearSystem           &system,
              Timings                &timings);

    /// Solves the stages from a state.
    /// @param record  in: stroke, step, contact, that of the model where it has no step; with `replay`, the
    /// recorded decisions are obeyed. Out: scheme, pairs, solves, energies, forces; iterations are added.
    /// @param guess  where the first stage begins
    SolvedIncrement forward(const Process<double>           &process,
                            const WorkpieceState<3, double> &state,
                            bool                             replay,
                            const InitialGuess              &guess,
                            IncrementRecord                 &record);

    /// Returns the same from what was recorded, to the bit: nothing is solved.
    SolvedIncrement recorded(const Process<double>           &process,
                             const WorkpieceState<3, double> &state,
                             const IncrementRecord           &record) const;

    /// Returns the derivative of X_{i+1} along (state, process), at a recorded increment.
    NodalVectors<Dual> tangent(const Process<Dual>           &process,
                               const WorkpieceState<3, Dual> &state,
                               const IncrementRecord         &record,
                               const TangentObserver         &observer);

    /// Reverse of forward, for several scalars at once: they share the matrix and its preconditioner, and
    /// each has a solve per stage of its own. The costates' positions and velocity are those at the end on
    /// entry, at the start on exit; to the rest they add what laws that depend on it take.
    /// @param state  at the start of the increment; all but its motion is read where laws depend on it
    /// @param source  of each stage: objectives, and the steps that follow mechanics
    void reverse(const Process<double>           &process,
                 const WorkpieceState<3, double> &state,
                 const IncrementRecord           &record,
                 const AdjointSource             &source,
                 std::vector<Costate>            &costates);

    /// Returns the mean velocity of the nodes in a recorded increment, sum_s b_s v_s [mm/s].
    NodalVectors<double> mean_velocity(const IncrementRecord &record) const;

    /// Where the increment after a solved one begins: its last solution, and how it changed from stage to
    /// stage. Only what is recorded enters, so that a run that is resumed begins there, too.
    InitialGuess guess_after(const SolvedIncrement &solved, const IncrementRecord &record) const;

    /// Where a replay begins: at what was recorded.
    InitialGuess recorded_guess(const IncrementRecord &record) const;

    /// Returns X_{i+1} of a recorded increment from X_i, the same bits as the run's.
    NodalVectors<double> positions_after(const Process<double>      &process,
                                         const NodalVectors<double> &X,
                                         const IncrementRecord      &record) const;

    /// Forgets what earlier systems left: preconditioner and starts. Results then depend on the input only.
    void forget();

  private:
    /// That of which no stage is known.
    std::shared_ptr<IncrementStart<double>> start_of(const Process<double>           &process,
                                                     const WorkpieceState<3, double> &state,
                                                     const IncrementRecord           &record) const;
    /// That of an increment whose stages are recorded.
    std::shared_ptr<IncrementStart<double>> recorded_start(const Process<double>           &process,
                                                           const WorkpieceState<3, double> &state,
                                                           const IncrementRecord           &record) const;
    /// That of the record, which is the model's unless the run was restarted with another.
    const Scheme &scheme_of(const IncrementRecord &record) const;
    /// Change of (V, P) over the stroke from the first stage to the last; none where they are at one time.
    std::optional<Field<double>> rate(const IncrementRecord &record) const;
    /// @return nothing where a node ran into a die unwatched
    std::vector<SolveRecord> solve_stages(IncrementStart<double>     &start,
                                          const NodalVectors<double> &X,
                                          bool                        replay,
                                          bool                        all_found,
                                          const InitialGuess         &guess,
                                          IncrementRecord            &record);
    /// Energies and forces of the increment.
    void                               account(const SolvedIncrement &solved, IncrementRecord &record) const;
    SolvedIncrement                    recorded(std::shared_ptr<const IncrementStart<double>> start,
                                                const NodalVectors<double>                   &X,
                                                const IncrementRecord                        &record) const;
    std::shared_ptr<const SolvedStage> recorded_stage(const IncrementStart<double>   &start,
                                                      const NodalVectors<double>     &X,
                                                      const Scheme                   &scheme,
                                                      const std::vector<SolveRecord> &solves,
                                                      unsigned int                    s,
                                                      const NodeVector<3, double>    &bubbles = {}) const;
    /// Returns whether a node that was not watched ran into a die. Collective.
    bool        contacts_missed(const Equilibrium<double> &stage, const Field<double> &W) const;
    Field<Dual> tangent_field(const Equilibrium<Dual> &stage, const SolvedStage &at);

    const Scene     &scene_;
    const StepModel &model_;
    LinearSystem    &system_;
    Newton           newton_;
    Timings         &timings_;
    /// Of each stage and costate, from the increments reversed last: where the next adjoint system starts.
    std::vector<std::vector<std::vector<Field<double>>>> earlier_lambdas_;
    /// Of each stage of the increment reversed last.
    std::vector<NodeVector<3, double>> earlier_bubbles_;
  };
} // namespace retroforge
