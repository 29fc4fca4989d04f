// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/adjoint/sweep.h>
#include <retroforge/case/case.h>
#include <retroforge/case/earlier_start.h>
#include <retroforge/record/recording.h>

namespace retroforge
{
  /// A forging before it runs.
  struct ForgingProblem
  {
    /// That of a case at a design.
    /// @param forging_case  must live as long
    /// @param process  dies of another shape with their vertices there, as Design::process() gives them
    /// @param X_0      initial positions of the nodes of the case's billet
    ForgingProblem(const Case &forging_case, Process<double> process, NodalVectors<double> X_0);

    /// One made in memory.
    /// @param resolved    parameters that have their defaults
    /// @param mesh        of the billet, whose X are the initial positions
    /// @param objectives  those of the parameters where there are none
    ForgingProblem(Parameters       resolved,
                   TetMesh          mesh,
                   std::vector<Die> dies,
                   Process<double>  process,
                   Objectives       objectives = {});

    /// Makes it repeat the increments of another run. @param strokes  at which they end
    void repeat_steps(const std::vector<double> &strokes);

    Parameters                     parameters;
    std::shared_ptr<const TetMesh> billet, nominal_billet; ///< the latter tells lengths that are left open
    NodalVectors<double>           X_0;
    ForgingModel                   model;
    Process<double> process; ///< its dies' vertices are those of the model's dies, and it begins `earlier`
    EarlierStart    earlier; ///< none for one made in memory
    std::vector<NumericsSegment> segments;
    Objectives                   objectives;
  };

  /// The run of a forging: forwards, deciding everything, or along a record; differentiated backwards and
  /// forwards; replayed. What the commands and the tests do with a forging, they do with this.
  class ForwardRun
  {
  public:
    enum class Keep
    {
      nothing,
      few,       ///< increments in memory, where they take less than `few_bytes`
      increments ///< in memory
    };
    static constexpr std::size_t few_bytes = 1 << 26;

    /// @param timings  must live as long
    /// @param directory  where increments are recorded, or were; none: nowhere
    ForwardRun(ForgingProblem problem, Keep keep, Timings &timings, const std::string &directory = "");
    ForwardRun(const Case          &forging_case,
               Process<double>      process,
               NodalVectors<double> X_0,
               Keep                 keep,
               Timings             &timings,
               const std::string   &directory = "")
        : ForwardRun(ForgingProblem(forging_case, std::move(process), std::move(X_0)),
                     keep,
                     timings,
                     directory)
    {
    }
    ForwardRun(const ForwardRun &) = delete; // its members refer to each other

    /// Checks the scene before the first increment.
    /// @return what is doubtful about it   @throws Error  where nothing can come of it
    std::vector<std::string> check() const;

    /// Takes the state to where it stood after n recorded increments, to the bit.
    /// @param observer  is called after each increment
    void restore(unsigned int n, const Forging::RecordAccess &record, const Forging::Observer &observer);

    /// Goes on with other numerics from here.
    void change_numerics(const NumericsSegment &segment);

    /// Solves the increments that are left.
    /// @param observer  is called after each  @throws Error  where the forging cannot go on
    void forge(const Forging::Observer &observer = {});

    /// Returns whether some are.
    bool is_left() const;

    /// Returns the values of the objectives, after forge().  @throws Error  for one that is not finite
    std::vector<double> values();

    /// Returns them with what is reported beside each, after values(). Collective.
    std::vector<ObjectiveTrace::Evaluation> evaluations() const { return trace_.evaluate(state_); }

    /// Returns dPhi/dX_0 and dPhi/d(process) of combinations of objectives, by one backward sweep, after
    /// values(). The increments must be kept or recorded.
    AdjointSweep sweep(const std::vector<Combination> &combinations) const;

    /// Returns all objectives with their derivatives along one direction, by the direct method.
    std::vector<Dual> tangent(const Process<Dual> &process, NodalVectors<Dual> X_0) const;

    /// Obeys the decisions of the increments at another process from other positions, and solves.
    /// @return the state at the end
    ForgingState replay(const Process<double>      &process,
                        const NodalVectors<double> &X_0,
                        const Forging::Observer    &observer = {}) const;

    /// Returns the values of the objectives of such a replay, with the decisions of this run.
    std::vector<double> replayed_values(const Process<double>      &process,
                                        const NodalVectors<double> &X_0) const;

    /// Writes the increments that are kept into a folder from which a run goes on; on one rank.
    /// @param parameters  of the case at this design   @throws Error  if it cannot be written
    void write_record(const std::string &directory, const std::string &parameters) const;

    /// Returns what a record begins with.
    RecordHeader record_header(const std::string &parameters) const;

    const ForgingState &state() const { return state_; }
    /// Strokes at the ends of increments, over all operations [mm].
    const std::vector<double>  &strokes() const { return strokes_; }
    const Process<double>      &process() const { return problem_.process; }
    const NodalVectors<double> &X_0() const { return problem_.X_0; }
    const std::vector<Die>     &dies() const { return problem_.model.dies; }
    const ForgingModel         &model() const { return problem_.model; }
    const Objectives           &objectives() const { return problem_.objectives; }
    const ObjectiveTrace       &trace() const { return trace_; }
    MeshEpoch                  &first_epoch() const { return *first_epoch_; }
    Recording                  &recording() { return recording_; }
    const Recording            &recording() const { return recording_; }

    /// Returns whether derivatives and replays follow the trend across remeshings: where the mesh was made anew on the way.
    bool follows_trend() const;

    /// Returns whether the mesh may be made anew.
    bool remeshes() const
    {
      return problem_.segments[segment_].parameters.remeshing.when != RemesherParameters::When::never;
    }

  private:
    /// What a segment of the stroke is run with.
    struct SegmentRun
    {
      const PressParameters press;
      const Remesher        remesher;
      const Forging         forging;

      SegmentRun(const ForgingProblem &problem, std::size_t segment, Timings &timings);
      SegmentRun(const SegmentRun &) = delete; // its members refer to each other
    };

    RecordedForging recorded() const;

    /// Objectives that few increments make, forces as a rule, of a run whose last new mesh has little of the stroke before
    /// it: the increments on it would become longer and shorter by all that the strokes of new meshes move by, and what a
    /// new mesh takes to come to its dies would make their slopes. Of these objectives that stroke is held.
    struct LateForces
    {
      std::vector<bool>          objectives; ///< of the run, which are such
      std::vector<FollowingRule> rules;      ///< by which ends of increments move for them
    };

    /// Returns them, where there are any and their rules differ from following_rules().
    std::optional<LateForces> late_forces() const;

    /// The increments that began on a mesh that quality asked for.
    std::vector<unsigned int> remeshed_for_quality() const;

    ForgingState        replay(const Process<double>            &process,
                               const NodalVectors<double>       &X_0,
                               const std::vector<FollowingRule> &rules,
                               const Forging::Observer          &observer) const;
    std::vector<double> replayed_values(const Process<double>            &process,
                                        const NodalVectors<double>       &X_0,
                                        const std::vector<FollowingRule> &rules) const;

    /// A process that begins as much earlier as this run does.
    template <typename Number>
    Process<Number> begun(Process<Number> process) const
    {
      problem_.earlier.apply(process);
      return process;
    }

    /// Returns those of the increments, where their ends follow the state (steps/moved_ends.h); else none.
    std::vector<FollowingRule> following_rules() const;

    /// Takes the run into a segment, whose numerics the model has.
    void enter(std::size_t segment);

    /// Keeps an increment, solved or restored, the stroke at its end, and what objectives need of it.
    void follow(const IncrementEvent &event);

    ForgingProblem              problem_;
    Timings                    &timings_;
    std::shared_ptr<MeshEpoch>  first_epoch_;
    ObjectiveTrace              trace_;
    const bool                  can_go_back_; ///< the increments are kept or recorded
    Recording                   recording_;
    ForgingState                state_;
    std::vector<StrokeStep>     increments_;  ///< up to it
    std::vector<double>         strokes_;     ///< at their ends, over all operations [mm]
    std::size_t                 segment_ = 0; ///< that the state is in
    std::unique_ptr<SegmentRun> running_;     ///< of it
  };
} // namespace retroforge
