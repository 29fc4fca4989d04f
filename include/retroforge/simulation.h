// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/command_line.h>
#include <retroforge/output/field_writer.h>
#include <retroforge/output/history.h>
#include <retroforge/output/objective_history.h>
#include <retroforge/output/summary.h>
#include <retroforge/parameters.h>
#include <retroforge/resume.h>

#include <optional>
#include <set>

namespace retroforge
{
  class RecordWriter;

  /// The program: a case forged forwards, differentiated backwards, and checked. Members stand in the order
  /// in which data flows through them.
  class Simulation
  {
  public:
    Simulation(const CommandLine &command, MPI_Comm comm);
    ~Simulation();

    /// @return the exit status: 0, or 1 when a check failed
    int run();

  private:
    /// A part of the stroke over which the same numerics hold.
    struct Stretch
    {
      RecordedInput input;
      Parameters    parameters;
    };

    /// Makes sure that nothing of another run is lost or mixed with this one.  @throws Error
    void prepare_folder() const;
    /// Surfaces of the dies that are no planes, at the start of the run: die_NAME.stl.
    void write_dies() const;
    /// @return whether a check passed, or there was none
    bool forge_and_judge();
    /// Names of the dies that pressed no node.
    std::vector<std::string> untouched_dies() const;
    void                     forge();
    /// To the state after the last increment of the record in the output folder, which the run goes on from.
    void resume();
    /// Where the record that the run goes on from ends, other settings begin to hold, if some changed.
    void change_numerics();
    void print_resumed() const;
    /// Solves what is left of the stroke.
    void forge_on();
    /// What a user is told who stops the run.
    std::string way_on() const;
    /// What can be done when the run failed after some increments.
    std::string way_on_after_failure() const;
    /// Leaves the reason why the run failed, which is being thrown, and the workpiece there.
    void keep_failure() const;
    void differentiate();
    void sweep_back();
    void differentiate_directly();
    bool check();
    /// Keeps what of a check is done, however it ends.
    void keep_check(const std::vector<CheckRow> &rows, unsigned int remaining);
    /// Rows of a check of the same run that was stopped.
    std::vector<CheckRow> kept_check() const;
    void                  summarise();
    void                  summarise_objectives();
    void                  summarise_restarts();
    void                  write_summary();

    void                 watch(const IncrementEvent &event);
    void                 trace(const IncrementEvent &event);
    void                 write_sensitivity();
    std::vector<Stretch> make_stretches() const;
    /// Results that cannot be written are no reason to stop at the end of a run.  @throws Error
    void check_outputs() const;
    /// How often the objective's value stands in the whole part; NaN where it says nothing of that.
    double copies(const NamedObjective &objective) const;
    /// The recorded increments, from memory or from the record's file.
    Forging::Source source();
    RecordedForging recorded();
    /// Objectives of a run that decides everything anew, dies of other shape included.
    std::vector<double> forge_anew(const Process<double> &process, const NodalVectors<double> &X_0) const;
    ObjectiveOracle     oracle();
    /// The combinations of objectives that are differentiated, at given values of the objectives.
    template <typename Number>
    std::vector<Number> combine(const std::vector<Number> &values) const;

    const CommandLine command_;
    MPI_Comm          comm_;
    const bool        root_; ///< this rank writes
    Timings           timings_;

    std::string                     echo_; ///< the parameters as understood
    Parameters                      parameters_;
    const std::optional<Resumption> resumption_; ///< of a run that goes on
    const TetMesh                   billet_;
    Process<double>                 nominal_;
    Design                          design_;

    std::vector<double>  mu_;
    Process<double>      process_;
    NodalVectors<double> X_0_;
    ForgingModel         model_;

    Objectives               objectives_;
    std::vector<Combination> combinations_;
    std::shared_ptr<Leg>     first_leg_;
    Remesher                 remesher_;
    Forging                  forging_;

    std::set<unsigned int>       touched_; ///< dies that some node was pressed by
    std::vector<IncrementRecord> records_;
    ForgingState                 forged_;
    ObjectiveTrace               trace_;
    std::vector<double>          values_;               ///< of the objectives
    std::vector<Judged>          judged_;               ///< each combination that was differentiated
    double                       forging_seconds_ = 0.; ///< 0: unknown, the run was resumed
    std::vector<Stretch>         stretches_;
    /// Where increments began to be solved, for the time left: stroke [mm], and seconds of the run by then.
    double begin_stroke_ = 0., begin_seconds_ = std::numeric_limits<double>::quiet_NaN();

    std::unique_ptr<RecordWriter>     record_;
    std::unique_ptr<History>          history_;
    std::unique_ptr<ObjectiveHistory> objective_history_;
    std::unique_ptr<FieldWriter>      fields_;
    Summary                           summary_;
  };
} // namespace retroforge
