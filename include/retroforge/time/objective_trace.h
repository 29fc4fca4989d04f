// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/objectives.h>
#include <retroforge/time/forging.h>

namespace retroforge
{
  /// An increment as objectives of the path see it, its integrals still to be added.
  template <typename Number>
  PathRow<Number> row_of(const IncrementRecord &record, const Process<Number> &process);

  /// What an objective of the end sees: its target moves with the die's vertices.
  template <typename Number>
  FinalView<Number> final_view(const FinalObjective                &objective,
                               const Scene                         &scene,
                               const NodalVectors<Number>          &X,
                               const std::vector<Number>           &strain,
                               const std::vector<DieState<Number>> &dies);

  /// Follows a run and takes up what its objectives are made of. It watches runs, restored runs and replays
  /// alike, and is the same on every rank.
  class ObjectiveTrace
  {
  public:
    /// What is passed must live as long.
    ObjectiveTrace(const Objectives &objectives, const ForgingModel &model, const Process<double> &process);

    /// After each increment.
    void add(const IncrementEvent &event);

    /// Values after the increments so far. Objectives of a window that no increment has reached yet are NaN
    /// unless `complete`, where they throw Error.
    /// @param decide  whether objectives of the end choose their features anew; else they keep what they
    /// chose last
    std::vector<double> values(const ForgingState &state, bool decide, bool complete = true) const;

    /// What is reported beside a value: its summands, and other numbers.
    struct Diagnostics
    {
      std::map<std::string, double> parts, details;
    };

    /// Returns those of each objective, after values().
    std::vector<Diagnostics> diagnostics(const ForgingState &state) const;

    /// The rows of each objective; empty for one of the end.
    const std::vector<PathRows<double>> &rows() const { return rows_; }

  private:
    const Objectives             &objectives_;
    const ForgingModel           &model_;
    const Process<double>        &process_;
    std::vector<PathRows<double>> rows_;
  };
} // namespace retroforge
