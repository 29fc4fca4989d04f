// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/case/parameters.h>
#include <retroforge/case/restart_rules.h>
#include <retroforge/core/command_line.h>
#include <retroforge/core/timer.h>
#include <retroforge/design/mesh_anew.h>

#include <optional>

namespace retroforge
{
  /// A segment of the stroke over which the same numerics hold.
  struct NumericsSegment
  {
    RecordedInput input;
    Parameters    parameters;
  };

  /// The data that a run begins with: all that follows from the command and the case's parameters. Members
  /// stand in the order in which data flows through them.
  struct Case
  {
    /// @param timings  gets the time to mesh the billet
    /// @throws Error
    Case(const CommandLine &asked, Timings &timings, MPI_Comm comm);
    Case(const Case &) = delete; // its members refer to each other

    const CommandLine               command;
    const MPI_Comm                  comm;
    std::string                     echo; ///< the parameters as understood
    Parameters                      parameters;
    const std::optional<Resumption> resumption; ///< record of a run that goes on
    const TetMesh         nominal_billet; ///< meshed at the nominal design: what is left open follows from it
    const FirstMesh       first;          ///< meshed there or at Design/meshed at
    const TetMesh        &billet;         ///< the mesh of `first`
    const Process<double> nominal;
    const Design          design;

    const std::vector<double>  mu; ///< values of the design parameters
    const Process<double>      process;
    const NodalVectors<double> X_0;
    const ForgingModel         model;

    const Objectives objectives;
    /// Combinations of the objectives, each of which is differentiated.
    const std::vector<Combination> combinations;
    std::vector<NumericsSegment>   segments; ///< one more where a run that goes on changes its numerics

    BilletSize size() const { return parameters.size_of(nominal_billet); }

    /// Returns the wanted length of the edges of the nominal design [mm].
    double edge_length() const { return parameters.edge_length(nominal_billet); }

    /// Returns the combinations of objectives that are differentiated, at given values of the objectives.
    template <typename Number>
    std::vector<Number> combine(const std::vector<Number> &values) const
    {
      std::vector<Number> combined;
      for (const Combination &combination : combinations)
        combined.push_back(combination(values));
      return combined;
    }

    /// Returns whether the program writes increments to a record or goes on with one, so that a run that
    /// stops can go on.
    bool has_record() const { return parameters.output.record || command.resume; }
  };
} // namespace retroforge
