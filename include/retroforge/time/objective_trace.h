// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/objectives.h>
#include <retroforge/time/forging.h>

namespace retroforge
{
  /// An increment as objectives of the path see it, its integrals still to be added.
  /// @param process  in which its ends have not moved
  template <typename Number>
  PathRow<Number>
  row_of(const IncrementRecord &record, const Process<Number> &process, const MovedEnds<Number> &ends = {});

  /// Returns the derivatives in ends, which have not moved, of a scalar with the derivatives `bar` in row_of().
  /// @param dt  that the increment takes [s]
  MovedEnds<double> reverse_row(const IncrementRecord &record, double dt, const PathRow<double> &bar);

  /// What an objective of the end sees: its target moves with the die's vertices.
  template <typename Number>
  FinalView<Number> final_view(const FinalObjective            &objective,
                               const Scene                     &scene,
                               const WorkpieceState<3, Number> &workpiece,
                               const Physics<Number>           &physics);

  /// What is recorded of a run for its objectives, next to its increments.
  struct RecordedObjectives
  {
    std::vector<PathRows<double>> rows;      ///< of each objective; empty for one of the end
    std::vector<FinalDecisions>   decisions; ///< of each objective; empty for one of the path
  };

  /// Follows a run and takes up what its objectives are made of. It watches runs, restored runs and replays
  /// alike. Values are the same on every rank.
  class ObjectiveTrace
  {
  public:
    /// What is passed must live as long.
    /// @param decisions  what objectives of the end decided on the run that is replayed
    ObjectiveTrace(const Objectives           &objectives,
                   const Process<double>      &process,
                   std::vector<FinalDecisions> decisions = {});

    /// Takes up an increment that is complete.
    void add(const IncrementEvent &event);

    /// Lets objectives of the end decide, at the end of a run. Collective.
    /// @throws Error  where the workpiece cannot be judged
    void decide(const ForgingState &state);

    /// An objective's value, and what is reported beside it: its summands, and other numbers.
    struct Evaluation
    {
      double                        value;
      std::map<std::string, double> parts, details;
    };

    /// Evaluates each objective of a run that ended there, by the decisions taken. Collective.
    /// @throws Error  for one that is not defined
    std::vector<Evaluation> evaluate(const ForgingState &state) const;

    /// Returns the values of evaluate().
    std::vector<double> values(const ForgingState &state) const;

    /// Evaluates each objective as if the run ended there, by decisions that are taken for this and not kept.
    /// One that is not defined yet (no increment has reached its window) has the value NaN. Collective.
    std::vector<Evaluation> evaluate_so_far(const ForgingState &state) const;

    const RecordedObjectives &recorded() const { return recorded_; }

  private:
    const Objectives      &objectives_;
    const Process<double> &process_;
    RecordedObjectives     recorded_;
  };
} // namespace retroforge
