// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/optimization/local_model.h>
#include <retroforge/optimization/optimization_problem.h>
#include <retroforge/optimization/optimization_results.h>

namespace retroforge
{
  /// Prints how an optimisation goes on, and writes the folder of its results: tables, the best design as a
  /// parameter file, and the shapes of designs. All ranks call it; the first prints and writes.
  class OptimizationReporter
  {
  public:
    /// All arguments must live as long.
    OptimizationReporter(OptimizationProblem &problem, OptimizationResults &results);

    /// @throws Error  where results of something else are
    void prepare_folder();
    /// Prints what is optimised, and what is doubtful about the scenes. Collective.
    void begin() const;
    /// Notes where no parameter changes the objective at the start.
    void note_flat_start() const;
    void print(const std::vector<DifferenceCheck> &rows) const;
    void print_noise(const Evaluation &at) const;
    /// Prints a line, and flushes it.
    void print_line(const std::string &line) const;
    /// Prints the last design tried, and writes the tables.
    /// @param n_iterations  of the search so far
    void add_row(unsigned int n_iterations) const;
    /// Writes billet and forged shape of a design, for the eye and for other programs. Collective.
    void write_shapes(const Evaluation &evaluation, const std::string &name);
    void write_results() const;

  private:
    void print_search() const;
    /// Notes a scattered parameter whose own value is no sample.
    void         print_unscattered() const;
    void         print_row(const TrialRow &row, unsigned int n_iterations) const;
    unsigned int most_forgings_left(unsigned int n_iterations) const;
    /// Writes the shapes of one scenario. Collective over its ranks.
    void write_shapes_of(std::size_t scenario, const std::vector<double> &mu, const std::string &name);

    OptimizationProblem &problem_;
    OptimizationResults &results_;
  };
} // namespace retroforge
