// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/optimization/design_mesh_manager.h>
#include <retroforge/optimization/design_space.h>
#include <retroforge/optimization/evaluator.h>
#include <retroforge/optimization/merit.h>

namespace retroforge
{
  /// An optimisation problem: the scenarios that judge a design, the space of designs, the criteria, and
  /// values and gradients by forgings that decide everything anew, on a mesh that may be renewed. Members
  /// stand in the order in which data flows through them. Collective over all ranks.
  class OptimizationProblem
  {
  public:
    /// @throws Error  for what is wrong with the case, before anything is written
    OptimizationProblem(const CommandLine &command, MPI_Comm comm);
    OptimizationProblem(const OptimizationProblem &) = delete; // its members refer to each other

    /// Returns what comes of a design: behind the objectives the parameter that follows from the volume,
    /// which is no result of a forging, and not in the journal.
    Evaluation evaluate(const std::vector<double> &mu);
    Evaluation differentiate(const std::vector<double> &mu);
    /// Appends that parameter, of a design of one of the cases.
    Evaluation with_held(const Design &design, Evaluation evaluation) const;

    /// Forges on the candidate of the meshes from here on.
    void forge_on_candidate() { forge_on(*meshes.candidate().made, meshes.candidate().made_at); }
    /// Forges on the mesh in use again.
    void forge_on_present() { forge_on(meshes.now(), meshes.made_at()); }

    /// Names and units of all values of a design.
    std::vector<std::string> names() const;
    std::vector<std::string> units() const;

    /// Derivatives by the parameters of the objective, and of the limits by their multipliers.
    /// @param at  with gradients
    std::vector<double> lagrangian_slopes(const Evaluation &at, const std::vector<double> &multipliers) const;

    /// Returns whether this rank prints and writes.
    bool is_root() const { return groups.is_first_rank(); }

    const OptimizationParameters &parameters() const { return main.parameters.optimization; }

    std::string path_of(const std::string &file) const { return main.command.output_directory + "/" + file; }

    const bool       resumes; ///< from an earlier optimisation
    const RankGroups groups;

  private:
    Timings timings_;

  public:
    const Case        main;       ///< on the ranks of this rank's group, and on the first mesh
    Scenarios         scenarios;  ///< the main one on the present mesh
    const Objectives  objectives; ///< objectives of all scenarios
    const DesignSpace space;
    Criteria          criteria;
    const Scatter     scatter;
    Journal           journal;
    DesignMeshManager meshes;
    Evaluator         evaluator; ///< on the present mesh

  private:
    void forge_on(const Case &forging_case, const std::string &made_at);
    /// Refuses a start of which nothing can come.
    void check_start() const;
  };

  /// Names of the parameters that a case varies.
  std::vector<std::string> varied_parameters(const Case &main);
} // namespace retroforge
