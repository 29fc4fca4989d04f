// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/adjoint/adjoint_parameters.h>
#include <retroforge/case/check_parameters.h>
#include <retroforge/case/optimization_parameters.h>
#include <retroforge/case/scan_parameters.h>
#include <retroforge/contact/contact_parameters.h>
#include <retroforge/core/command_line.h>
#include <retroforge/core/parameter_input.h>
#include <retroforge/core/setting_tags.h>
#include <retroforge/design/design.h>
#include <retroforge/design/design_parameters.h>
#include <retroforge/discretization/discretization_parameters.h>
#include <retroforge/material/heat_parameters.h>
#include <retroforge/material/material_parameters.h>
#include <retroforge/objective/objective_parameters.h>
#include <retroforge/output/output_parameters.h>
#include <retroforge/time/forging.h>

#include <functional>
#include <iosfwd>
#include <optional>

namespace retroforge
{
  /// Size of the billet, from which parameters left open follow.
  struct BilletSize
  {
    double side;   ///< cube root of the mesh's volume [mm]
    double height; ///< height of the whole billet; for one from a file, along the way of the leading die [mm]
    double extent = 0.; ///< of the mesh along the way of the leading die [mm]
  };

  /// All settings of a parameter file.
  struct Parameters
  {
    BilletParameters           billet;
    std::vector<DieParameters> dies;
    MaterialParameters         material;
    PressParameters            press;
    DiscretizationParameters   discretization;
    ContactParameters          contact;
    HeatParameters             heat;
    NewtonParameters           newton;
    LinearSolverParameters     linear_solver;
    ObjectivesParameters       objectives;
    DesignParameters           design;
    CheckParameters            check;
    ScanParameters             scan;
    OptimizationParameters     optimization;
    OutputParameters           output;
    AdjointParameters          adjoint;
    RemesherParameters         remeshing;

    std::vector<std::string> without_effect; ///< a sentence on each setting that nothing reads

    /// The names in a list, as `Dies/names`, each of which has a section of a kind, as `Die NAME`.
    using NamesOf = std::function<std::vector<std::string>(const std::string &kind,
                                                           const std::string &list,
                                                           const std::string &by_default)>;

    /// Declares everything, with a section for each name.
    void add_parameters(dealii::ParameterHandler &prm, const NamesOf &names_of);

    /// Reads a file and overrides, and checks all of it.  @throws Error
    static Parameters read(const std::string                                      &file,
                           const std::vector<std::pair<std::string, std::string>> &overrides,
                           std::string                                            &echo);
    /// Reads a command's case, with its settings.
    static Parameters read(const CommandLine &command, std::string &echo);

    /// Reads the complete input of an earlier run, as its record has it. Settings that are not known any more are left out
    /// where they change nothing of the forging.  @throws Error
    static Parameters of_record(const std::string &text);

    /// Returns what the rooms say of their settings; of dies and objectives by the name `*`.
    static const SettingTags &tags();

    /// A case to start from: all parameters with their meaning, a box between two planes.
    static void print_template(std::ostream &out);

    /// Sections of dies that no list names, as the end of a message: a die that is missing may be there.
    std::string unlisted_dies() const;

    /// Leaves out, in a run that takes no derivatives, design parameters that would change nothing.
    void leave_out_idle_parameters();

    /// Resolves what is left open, as the number of increments, and checks what follows from the parameters.
    /// @throws Error  where steps, contact or penalty come out zero or infinite
    Parameters &resolve_defaults(const BilletSize &size);

    /// Whether other designs repeat the increments of the nominal one; given ones, all designs have.
    bool repeats_steps() const { return design.repeat_steps && press.steps_file.empty(); }

    /// Returns the process as the file has it.
    Process<double> process(const BilletSize &size) const;
    /// Returns what its contact law follows from.
    OpenContact open_contact(const BilletSize &size) const;
    /// Returns the size of a billet: the same for a sector as for the whole it is part of, but for `side`.
    BilletSize size_of(const TetMesh &billet) const;
    /// Returns the model of increments, once defaults are resolved.
    StepModel step_model() const;
    /// Makes the objectives, once defaults are resolved.  @throws Error
    Objectives make_objectives(const std::vector<Die> &made_dies, const TetMesh &billet) const;
    /// Returns what is differentiated: each objective, or their weighted sum.
    std::vector<Combination> combinations(const Objectives &made_objectives) const;
    /// Wanted length of the edges in remeshing [mm]; of a billet from a file, the mean length there is.
    double edge_length(const TetMesh &billet) const;

    /// Returns parameters, `echo`, as a parameter file in another folder has them: they name the same files as seen
    /// from there. No file is read.
    /// @param changes  other values, as they stand in that file
    static std::string seen_from(const std::string                                      &folder,
                                 const std::string                                      &echo,
                                 const std::vector<std::pair<std::string, std::string>> &changes = {});

  private:
    enum class Origin
    {
      user,
      record ///< written by a program that may have been an earlier one
    };

    /// @param file  of the case, beside which other files are looked for
    static Parameters of_lines(const std::string         &file,
                               std::vector<ParameterLine> lines,
                               std::string               &echo,
                               Origin                     origin = Origin::user);
    /// Declares what the lines name, and takes their values.
    void
    assign(std::vector<ParameterLine> lines, dealii::ParameterHandler &prm, Origin origin = Origin::user);

    // Once defaults are resolved:
    double edge_stiffness_ = 1.; ///< penalty of edges over that of nodes
    double touching_gap_   = 0.; ///< gap up to which objectives see nodes touch in part [mm]

    /// By which the dies close over the stroke [mm]: the stroke itself, where one die moves.
    double                        closing_path() const;
    std::vector<DieState<double>> initial_states() const;
    /// Returns the pressure of a frictionless upsetting [MPa].
    double       mean_pressure(const BilletSize &size) const;
    void         check_all();
    void         find_without_effect(const std::vector<ParameterEntry> &entries);
    void         check_heat() const;
    void         check_derived(const BilletSize &size) const;
    unsigned int leading_die() const;
    /// @throws Error  where Heat/resting die names none
    unsigned int resting_die() const;
  };
} // namespace retroforge
