// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <string>
#include <vector>

namespace retroforge
{
  /// One design of a scan, and what its run found.
  struct ScanPoint
  {
    struct Objective
    {
      std::string name, unit;
      double      value; ///< NaN where there is none
      double      slope; ///< in the parameter varied, by the run's own gradient; NaN where there is none
    };

    std::string            parameter;
    double                 value = 0.;
    std::string            directory;
    std::vector<Objective> objectives;     ///< empty where the run failed
    std::string            failure;        ///< why it did
    unsigned int           increments = 0; ///< of the run; 0 where it failed
    bool                   reused     = false;

    /// Takes the objectives from the summary in `directory`, if there is one of this command, made by this
    /// build.
    /// @return whether there is
    bool read_summary(const std::string &command);

    /// The reason of a run that left no summary, from what it printed.
    void read_failure(const std::string &log, int status, int signal);
  };
} // namespace retroforge
