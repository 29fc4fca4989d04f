// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/optimization/meshes.h>
#include <retroforge/optimization/optimization_results.h>
#include <retroforge/optimization/search.h>
#include <retroforge/optimization/trials.h>

namespace retroforge
{
  /// The command optimize: the design of a case with the least objective within bounds and limits, by
  /// forgings that decide everything anew and gradients of the backward sweep: what a Search asks for, the
  /// folder of results and what is printed. Members stand in the order in which data flows through them.
  class Optimize
  {
  public:
    /// @throws Error  for what is wrong with the case, before anything is written
    Optimize(const CommandLine &command, MPI_Comm comm);

    /// @return the exit status: that of the results
    int run();

  private:
    /// @throws Error  where results of something else are, or a journal of another case or program
    void prepare_folder();
    /// With what an earlier run left, where this one goes on.  @throws Error  for one of another case
    Journal make_journal() const;
    /// With the forgings of the finer case that are done, where it is still the same.
    Journal confirmation_journal(const Operations &fine) const;
    /// Why the optimum is not forged on finer meshes; empty where it is.
    std::string no_finer_mesh() const;

    /// What the search forges, and what becomes of its decisions.
    SearchTask search_task();

    /// Whether the search is to go on with a new mesh; says why it does not where one was asked for.
    bool mesh_is_bad(const Evaluation &now);
    /// Forges the design again on the new mesh, and stays with the old one where that fails.
    std::optional<Evaluation> renew_mesh(const Evaluation &now);
    void                      forge_on(const Case &at, const std::string &made_at);

    /// What comes of a design: behind the objectives the parameter that follows from the volume, which is no
    /// result of a forging, and not in the journal.
    Evaluation evaluate(const std::vector<double> &mu);
    Evaluation differentiate(const std::vector<double> &mu);
    Evaluation with_held(const Design &design, Evaluation evaluation) const;

    void begin();
    /// The gradient at the start by differences, for a user who asks.
    void check();
    void measure_noise();
    /// Accepted, within the limits, and the least of those; the least beyond its limits where none is. Of
    /// those forged on the present mesh: values of another one differ by the scatter of meshes.
    Evaluation best_so_far() const;
    /// Derivative by the parameters of the objective and of the limits by their multipliers.
    std::vector<double> lagrangian_slopes(const Evaluation &at) const;
    void                report_best();
    void                confirm();

    void add_row(TrialRow::Decision decision, const Evaluation &evaluation, double radius);
    void print_search() const;
    /// Of a scattered parameter whose own value is no sample.
    void         print_unscattered() const;
    void         note_flat_start() const;
    unsigned int most_forgings_left() const;
    void         print_row(const TrialRow &row) const;
    /// Billet and forged shape of a design, for the eye and for other programs.
    /// Collective.
    void write_shapes(const Evaluation &evaluation, const std::string &name);
    void write_results() const;
    /// The shapes of one operation. Collective over its ranks.
    void write_shapes_of(std::size_t operation, const std::vector<double> &mu, const std::string &name);
    /// A case's, at another design. @param mu  parameters of that case  @param files  other names of files
    std::string parameters_at(const Case                                             &at,
                              const std::vector<double>                              &mu,
                              const std::vector<std::pair<std::string, std::string>> &files = {}) const;
    std::string path_of(const std::string &file) const { return case_.command.output_directory + "/" + file; }

    const bool       resume_;
    const RankGroups groups_;
    Timings          timings_;
    Case             case_;       ///< on the ranks of this rank's group
    Operations       operations_; ///< the main one on the present mesh
    const Objectives objectives_; ///< of all operations
    const bool       root_;       ///< this rank prints and writes
    DesignSpace      space_;
    Criteria         criteria_;
    Scatter          scatter_;
    Journal          journal_;
    Meshes           meshes_;
    Trials           trials_; ///< on the present mesh

    Search              search_;
    OptimizationResults results_;
  };
} // namespace retroforge
