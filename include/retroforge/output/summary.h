// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/whole_part.h>

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace retroforge
{
  /// Results of a run, for programs to read (.json). The format is described in doc/summary_schema.md;
  /// whoever changes a key changes `Summary::schema` and that page.
  ///
  /// Numbers never set (and those that are not finite) become null; empty lists and maps are left out.
  struct Summary
  {
    static constexpr int    schema  = 1;
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    using Count = std::optional<std::uint64_t>;

    struct Objective
    {
      std::string                   name;
      double                        value = unknown;
      std::string                   unit;
      std::map<std::string, double> parts;           ///< summands of the value, e.g. deformation and friction
      std::map<std::string, double> details;         ///< other numbers told beside it, e.g. the true maximum
      double                        whole = unknown; ///< value for the whole part, where it adds up over it
      std::string                   note  = {};      ///< what a user must know of it; empty: nothing
    };

    struct Parameter
    {
      std::string                   name;
      double                        value = unknown;
      std::string                   unit;
      std::map<std::string, double> gradient; ///< by objective
      /// Length or size that percentages of the parameter are taken of.
      double scale = unknown;
      /// By objective, how far the derivative holds, in words; without those of which it is not known.
      std::map<std::string, std::string> trust = {};
    };

    /// Finite differences of one step: with the recorded decisions replayed, and free (decided anew).
    struct CheckStep
    {
      double step              = unknown;
      double replayed_central  = unknown;
      double replayed_forward  = unknown;
      double replayed_backward = unknown;
      double free_central      = unknown;
    };

    /// One derivative, computed in every way.
    struct Check
    {
      std::string            objective;
      std::string            parameter;
      double                 adjoint = unknown;
      double                 tangent = unknown;
      std::vector<CheckStep> steps;
      std::vector<double>    taylor_orders;
      std::string            verdict;   ///< "passed", "failed", or "zero" where there is no dependence
      std::string            failed_by; ///< in words; empty where it passed
      /// What the free differences have in common: a slope, and jumps over the value of the objective.
      double free_slope = unknown, free_uncertainty = unknown, free_jumps = unknown;
      bool   is_doubtful = false; ///< that slope is more than half beside the adjoint
    };

    std::string command, version, commit, blas;
    Count       ranks, n_nodes, n_cells;

    WholePart whole;

    std::vector<Objective> objectives;
    std::vector<Parameter> parameters;

    Count increments, cuts, remeshings, newton_iterations, krylov_iterations, linear_solves_forward,
      linear_solves_adjoint;

    double volume_initial = unknown; ///< of the mesh, mm^3
    double volume_final   = unknown;
    double volume_of_shape =
      unknown; ///< of the billet that the mesh stands for, whose round sides are no chords
    double volume_change() const { return volume_final / volume_initial - 1.; }
    double volume_repaired = 0.; ///< taken away where metal was thinner than an element, mm^3

    /// The deepest the surface has been in a die, over the run.
    struct Depth
    {
      double                depth    = unknown; ///< mm
      double                relative = unknown; ///< over the element size
      double                stroke   = unknown; ///< at the end of the increment, mm
      std::array<double, 3> place    = {{unknown, unknown, unknown}};
      std::string           die;
    };
    Depth deepest;

    /// Work of the dies on gaps that close over the energy spent, dimensionless: over the run, and the size of
    /// it in single increments, which 95 % of them stay below and none exceeds.
    struct PowerBalance
    {
      double over_run = unknown, most_below = unknown, largest = unknown;
      double stroke = unknown; ///< at the end of the increment where it is largest, mm
    };
    PowerBalance balance;

    /// What heat did, and what of it a run without heat, or without conduction, leaves out, to tell when it matters.
    struct Heat
    {
      bool   warms            = false;   ///< the metal warms by its work
      bool   conducts         = false;   ///< and heat flows
      double warming          = unknown; ///< of the metal by its work, mean over the volume, K
      double seconds          = unknown; ///< on the dies, under the press and before
      double chilled          = unknown; ///< depth that a chill by the dies reaches, mm
      double elements         = unknown; ///< the same in elements
      double mean_temperature = unknown; ///< of the metal at the end where it is followed, C

      /// Before the stroke of an operation, s.
      struct Wait
      {
        double transfer = 0., dwell = 0.;
      };
      std::vector<Wait> waits; ///< of each operation, where heat flows
    };
    Heat heat;

    /// Quadratic velocities: where most surface edges, of those that touched, spanned a corner of a die.
    struct Spanned
    {
      unsigned int          touching = 0, spanning = 0; ///< edges
      double                bulge  = unknown;           ///< of the die into the worst one, over its length
      double                stroke = unknown;           ///< at the end of the increment, mm
      std::array<double, 3> place  = {{unknown, unknown, unknown}};
      std::string           die;

      double share() const { return touching == 0 ? 0. : double(spanning) / touching; }
    };
    Spanned spanned;

    /// A point from which the run went on with other settings.
    struct Restart
    {
      unsigned int                                               increment; ///< the first with them, from 1
      double                                                     stroke;    ///< where it began, mm
      std::map<std::string, std::pair<std::string, std::string>> changed;   ///< before and after
    };
    std::vector<Restart> restarts;

    /// Warnings that a user must know to trust the numbers: a sentence or two each.
    std::vector<std::string> warnings;

    std::map<std::string, double> wall_seconds;
    Count                         record_bytes;

    std::vector<Check> check;
    Count              check_remaining; ///< directions not yet checked; unset but for a check

    /// The text of the file.
    std::string to_json() const;

    /// Replace `file` in one step.  @throws Error if it cannot be written
    void write(const std::string &file) const;
  };
} // namespace retroforge
