// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/case/parameters.h>
#include <retroforge/core/command_line.h>
#include <retroforge/scan/child_processes.h>
#include <retroforge/scan/scan_results.h>

namespace retroforge
{
  struct Case;

  /// The command `scan`: design parameters varied one after the other on the first mesh of the nominal
  /// design. Each point is a run of this program of its own, in `points/` below the folder of the results,
  /// that a user can repeat by hand (`command.txt`). The nominal design runs first: points repeat its increments.
  class Scan
  {
  public:
    /// @param environment  of the runs: that of this program before MPI added to it
    /// @throws Error  where the case is wrong, or this is one of several ranks
    Scan(const CommandLine &command, std::vector<std::string> environment, MPI_Comm comm);

    /// @return the exit status: 0, or 1 when every point failed
    int run();

  private:
    void make_lines(const Case &scene);
    void prepare_folder() const;
    /// Returns what commands of all designs have in common, in folder `name` of the points.
    CommandLine              command_in(const std::string &name, Command chosen) const;
    CommandLine              command_of_nominal() const;
    CommandLine              command_of(const ScanPoint &point) const;
    std::vector<std::string> words_of(const CommandLine &command) const;
    /// Whether a design has results of a command already.
    bool is_finished(const CommandLine &run, ScanPoint &design) const;
    /// Forges the nominal design, whose increments points repeat, unless they need not or it is done.
    void run_nominal();
    /// Makes the folder of a run.
    ChildProcess             prepared(const CommandLine &run) const;
    std::vector<ScanPoint *> to_do();
    void                     run_points(const std::vector<ScanPoint *> &points);
    void                     finish(ScanPoint &point, const ExitStatus &end) const;
    unsigned int             at_a_time() const;

    const CommandLine              command_;
    const std::vector<std::string> environment_;
    std::string                    echo_;     ///< the parameters as understood
    std::vector<std::string>       warnings_; ///< of the scene
    Parameters                     parameters_;
    std::vector<ScanLine>          lines_;
    std::string                    steps_; ///< table of the increments that points repeat; empty: they choose
  };
} // namespace retroforge
