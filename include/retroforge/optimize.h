// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/optimisation/minimise.h>
#include <retroforge/optimisation/optimisation_results.h>
#include <retroforge/trials.h>

namespace retroforge
{
  /// The command optimize: the design of a case with the least objective within bounds and limits, by
  /// forgings that decide everything anew and gradients of the backward sweep.
  ///
  /// Limits are kept by an augmented Lagrangian, minimised between bounds again and again, with multipliers
  /// that fit the gradients best at the end of each. Members stand in the order in which data flows through
  /// them.
  class Optimize
  {
  public:
    /// @throws Error  for what is wrong with the case, before anything is written
    Optimize(const CommandLine &command, MPI_Comm comm);

    /// @return the exit status
    int run();

  private:
    /// @throws Error  where results of something else are, or a journal of another case or program
    void prepare_folder();
    /// With what an earlier run left, where this one goes on.  @throws Error  for one of another case
    Journal make_journal() const;
    /// With the forgings of the finer case that are done, where it is still the same.
    Journal confirmation_journal(const std::string &parameters) const;

    void begin();
    /// The gradient at the start by differences, for a user who asks.
    void check();
    void measure_noise();
    void search();
    /// The merit over scaled variables, from the present design.
    BoundedProblem problem();
    /// One minimisation with the multipliers there are; from the best design, to the last accepted one.
    void minimise_merit();
    bool go_on(const MinimiserState &state);
    /// J^T J v: of the misfit of data, its Hessian where they agree with the forging; of the penalty of
    /// limits, what does not come from their curvature.
    std::vector<double> known_hessian(const std::vector<double> &v) const;
    /// Limits whose penalty is felt at the present design.
    std::vector<unsigned int> pressing() const;
    /// Multipliers that fit the gradients at the present design.
    std::vector<double> fitted_multipliers() const;
    bool                limits_are_settled(const std::vector<double> &multipliers) const;
    /// Accepted, within the limits, and the least of those; the least beyond its limits where none is.
    Evaluation best_so_far() const;
    /// Derivative by the parameters of the objective and of the limits by their multipliers.
    std::vector<double> lagrangian_slopes(const Evaluation &at) const;
    void                report_best();
    void                confirm();

    double value_at(const std::vector<double> &x);
    void   decided(const std::vector<double> &x, bool accepted);

    void add_row(TrialRow row);
    void print_search() const;
    void print_row(const TrialRow &row) const;
    /// Billet and forged shape of a design, for the eye and for other programs.
    /// Collective.
    void write_shapes(const Evaluation &evaluation, const std::string &name);
    void write_results() const;
    /// The case's, at another design.
    std::string parameters_at(const std::vector<double> &mu) const;
    std::string path_of(const std::string &file) const { return case_.command.output_directory + "/" + file; }

    const bool  resume_;
    Timings     timings_;
    Case        case_;
    const bool  root_; ///< this rank writes
    DesignSpace space_;
    Criteria    criteria_;
    Scatter     scatter_;
    Journal     journal_;
    Trials      trials_;

    Merit               merit_;
    Minimiser           minimiser_;
    Evaluation          now_; ///< the design accepted last, with gradients
    double              radius_     = 0.;
    unsigned int        iterations_ = 0;
    OptimisationResults results_;
  };
} // namespace retroforge
