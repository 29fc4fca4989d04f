// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/optimization/optimization_reporter.h>
#include <retroforge/optimization/search.h>

namespace retroforge
{
  /// The command optimize: finds the design of a case with the least objective within bounds and limits, by
  /// forgings that decide everything anew and gradients of the backward sweep. A Search chooses the designs
  /// of an OptimizationProblem, and an OptimizationReporter tells what comes of them.
  class Optimize
  {
  public:
    /// @throws Error  for what is wrong with the case, before anything is written
    Optimize(const CommandLine &command, MPI_Comm comm);

    /// @return the exit status: that of the results
    int run();

  private:
    /// Returns what the search forges, and what becomes of its decisions.
    SearchTask search_task();

    /// Returns whether the search is to go on with a new mesh; says why it does not where one was asked for.
    bool mesh_is_bad(const Evaluation &now);
    /// Forges the design again on the new mesh, and stays with the old one where that fails.
    std::optional<Evaluation> renew_mesh(const Evaluation &now);

    void begin();
    /// Around the design accepted last. @return whether all designs were forged that it asks for
    bool measure_noise();
    /// How a search ended, and whether limits are kept there and no multiplier would change it.
    struct SearchEnd
    {
      bool       settled;
      SearchStop stop;
    };
    /// Where the noise of the start ends the first search elsewhere, it is measured again, and the search goes on if it is much less.
    SearchEnd run_search();
    /// Goes on from the design accepted last, to the end of the search and what is told of it.
    /// @return whether it came there: of one that is cut off after a confirmation nothing is taken
    bool search();
    void confirm(bool goes_on);
    /// Lets limits that the confirmation misses count what it added to their values, and tells so.
    void correct_limits();
    /// Returns why limits that the confirmation misses are not corrected. @param n_corrections  so far
    std::string why_not_corrected(unsigned int n_corrections) const;
    /// Accepted, within the limits, and the least of those; the least beyond its limits where none is. Of
    /// those forged on the present mesh: values of another one differ by the scatter of meshes.
    Evaluation best_so_far() const;
    void       report_best();
    void       add_row(TrialRow::Decision decision, const Evaluation &evaluation, double radius);

    OptimizationProblem  problem_;
    OptimizationResults  results_;
    OptimizationReporter reporter_;
    Search               search_;
  };
} // namespace retroforge
