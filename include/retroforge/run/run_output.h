// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/case/case.h>
#include <retroforge/output/field_writer.h>
#include <retroforge/output/history.h>
#include <retroforge/output/objective_history.h>
#include <retroforge/output/summary.h>
#include <retroforge/output/time_left.h>
#include <retroforge/run/power_balance.h>
#include <retroforge/run/slope_trust.h>
#include <retroforge/time/objective_trace.h>

#include <memory>
#include <set>

namespace retroforge
{
  /// Follows a forging and tells of it: a line per increment on the console and in history.csv, the
  /// objectives in objectives.csv, the shapes in fields.pvd. All ranks follow; the first writes, and of
  /// the fields each its own.
  class RunOutput
  {
  public:
    /// @param process  that of the run
    /// @param trace    that followed the run up to where add() is called; it, the case and the process must live as long
    /// @throws Error  if a file cannot be written
    RunOutput(const Case            &forging_case,
              const Process<double> &process,
              const WholePart       &whole,
              const ObjectiveTrace  &trace,
              Timings               &timings);

    /// From here on increments are solved, as far as the time left is concerned.
    void begin();

    /// The end of an increment, solved or restored. Collective.  @throws Error  if a file cannot be written
    void add(const IncrementEvent &event);

    /// The workpiece where the run failed.
    void add_failed(const ForgingState &state);

    /// The deepest that the surface has been in a die.
    const Summary::Depth &deepest() const { return deepest_; }

    /// The increment in which most edges of quadratic velocities spanned corners.
    const Summary::Spanned &spanned() const { return spanned_; }

    /// What each increment decided.
    const std::vector<IncrementDecisions> &decisions() const { return decisions_; }

    Summary::PowerBalance balance() const { return balance_.summary(); }

    /// Names of the dies that pressed no node.
    std::vector<std::string> untouched_dies() const;

  private:
    void       add_objectives(const ForgingState &state);
    HistoryRow row_of(const IncrementEvent &event);
    void       print(const IncrementEvent &event, const HistoryRow &row);
    void       watch_edges(const IncrementEvent &event);
    /// Every so many increments, and at the end.
    bool is_due(const ForgingState &state, unsigned int every) const;
    /// Returns whether fields are written at the end of an increment.
    bool shows(const IncrementEvent &event) const;

    const Case            &case_;
    const Process<double> &process_;
    const WholePart        whole_;
    const ObjectiveTrace  &trace_;
    Timings               &timings_;

    std::set<unsigned int> touched_; ///< dies that some node was pressed by
    Summary::Depth         deepest_;
    Summary::Spanned       spanned_;
    PowerBalance           balance_;

    std::vector<IncrementDecisions> decisions_;

    TimeLeft time_left_;
    double   seconds_ = Summary::unknown; ///< of the run by the end of the increment before

    std::unique_ptr<History>          history_;
    std::unique_ptr<ObjectiveHistory> objectives_;
    FieldWriter                       fields_;
  };
} // namespace retroforge
