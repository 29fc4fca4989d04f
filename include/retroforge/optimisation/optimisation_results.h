// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/optimisation/confidence.h>
#include <retroforge/optimisation/search.h>

#include <iosfwd>
#include <map>
#include <optional>

namespace retroforge
{
  /// A design that an optimisation tried, and what it made of it.
  struct TrialRow
  {
    enum class Decision
    {
      start,
      noise, ///< forged to measure the noise
      accepted,
      refused
    };

    Decision   decision;
    Evaluation evaluation;
    double     merit  = 0.; ///< what the optimiser compares; infinite where the forging failed
    double     radius = 0.; ///< of the trust region it was taken from, in scales
  };

  /// Start and optimum forged with smaller elements and increments.
  struct Confirmation
  {
    Evaluation   start, best;
    unsigned int n_nodes = 0, n_increments = 0;
  };

  /// What an optimisation found.
  struct OptimisationResults
  {
    const DesignSpace             &space;
    const Criteria                &criteria;
    const std::vector<std::string> objectives; ///< names of all of the case
    const std::vector<std::string> units;      ///< theirs

    std::map<std::string, std::vector<std::string>> operations =
      {}; ///< others: parameters of the design they have

    std::vector<TrialRow>       rows  = {};
    double                      noise = 0.; ///< of the objective, in its unit
    SearchStop                  stop  = SearchStop::running;
    Evaluation                  start = {}, best = {};   ///< with gradients
    std::vector<double>         multipliers        = {}; ///< of the limits, per unit of the limit's excess
    std::vector<double>         by_moving_relation = {}; ///< objective per unit of each relation's bound
    std::optional<Confidence>   confidence         = {}; ///< where there are data
    std::optional<Confirmation> confirmation       = {};
    unsigned int                n_simulations = 0, n_sweeps = 0, n_failed = 0;

    double value(const Evaluation &evaluation) const { return criteria.value(evaluation.values); }
    /// What the objective would change by, per unit by which a limit is relaxed.
    double by_relaxing(std::size_t limit) const;

    void write_csv(const std::string &file) const;
    void write_json(const std::string &file) const;
    void print(std::ostream &out) const;
  };

  std::string in_words(SearchStop stop);
  std::string in_words(TrialRow::Decision decision, bool failed);
} // namespace retroforge
