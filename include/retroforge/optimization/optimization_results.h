// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/optimization/confidence.h>
#include <retroforge/optimization/confirmation.h>
#include <retroforge/optimization/noise_estimate.h>
#include <retroforge/optimization/search.h>

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
      refused,
      renewed ///< forged again, on a new mesh
    };

    Decision     decision;
    Evaluation   evaluation;
    double       merit  = 0.; ///< merit that the optimiser compares; infinite where the forging failed
    double       radius = 0.; ///< radius of the trust region it was taken from, in scales
    unsigned int mesh   = 0;  ///< mesh that it was forged on, the first one 0

    bool becomes_the_next() const { return decision != Decision::noise && decision != Decision::refused; }
  };

  /// A mesh of the billet made anew at a design, which was forged on the one before and on this one.
  struct NewMesh
  {
    std::size_t         row = 0; ///< row of the second forging
    std::string         made_at; ///< as in Design/meshed at
    unsigned int        n_nodes        = 0;
    double              quality_before = 0., quality_after = 0.; ///< quality of the worst cell: tet_quality()
    double              volume_before = 0., volume_after = 0.;   ///< volume of the billet [mm^3]
    std::vector<double> before, after;                           ///< values of the objectives
  };

  /// Designs near the best one, beside what its gradients predict.
  struct Neighbours
  {
    unsigned int        n = 0;
    std::vector<double> off; ///< rms of each value, in its unit; empty where there are less than three
  };

  /// Results of an optimisation.
  struct OptimizationResults
  {
    const DesignSpace &space;
    const Criteria    &criteria;
    /// Names of all of the case, and behind them that of the parameter that follows from the volume, if any.
    const std::vector<std::string> objectives;
    const std::vector<std::string> units; ///< theirs

    std::map<std::string, std::vector<std::string>> operations =
      {}; ///< others: parameters of the design they have

    double limit_tolerance = 0.; ///< part of a limit by which it may be exceeded

    /// Meaning of the objectives' values where each design is forged several times; empty where it is once.
    std::string counted_as = {};

    std::vector<TrialRow> rows   = {};
    std::vector<NewMesh>  meshes = {}; ///< after the first
    Noise                 noise  = {}; ///< 0 and empty where it is not measured
    SearchStop            stop   = SearchStop::running;
    Evaluation            start = {}, best = {}; ///< with gradients
    /// Multipliers of the limits, per unit of the limit's excess.
    std::vector<double>         multipliers        = {};
    std::vector<double>         by_moving_relation = {}; ///< objective per unit of each relation's bound
    std::optional<Confidence>   confidence         = {}; ///< confidence, where there are data
    std::optional<Confirmation> confirmation       = {};
    /// Why the search did not go on for limits that the confirmation misses; empty where there are none.
    std::string not_corrected = {};
    bool        goes_on       = false; ///< a search with corrected limits is under way
    /// Told beside values of the best design's forging, as the true maximum beside a smooth one: of each
    /// objective of the case itself, in its unit unless their names say other.
    std::vector<std::map<std::string, double>> details = {};
    std::vector<std::string>                   warnings =
      {}; ///< of how the best design begins and ends, as `simulate' tells them
    unsigned int n_simulations = 0, n_sweeps = 0, n_failed = 0; ///< forgings, sweeps, designs

    double value(const Evaluation &evaluation) const { return criteria.value(evaluation.values); }
    /// Returns the change of the objective per unit by which a limit is relaxed; NaN where the search did not
    /// come to its end within all limits, or ended beside this one by less than its noise without a multiplier.
    double by_relaxing(std::size_t limit) const;
    /// Returns the amount by which the best design misses a limit, in its unit; 0 where it keeps it, to the
    /// tolerance.
    double missed_by(std::size_t limit) const;
    /// Returns whether limits are missed, each by no more than its noise.
    bool missed_only_by_noise() const;
    bool limits_are_kept() const { return criteria.largest_excess(best.values) <= limit_tolerance; }
    /// Returns the noise of what a limit is set on, in its unit.
    double noise_of(const Limit &limit) const
    {
      return noise.values.empty() ? 0. : noise.values[limit.objective];
    }
    /// Returns whether the best design is nearer to a limit than its noise.
    bool is_within_noise(const Limit &limit) const;
    /// Returns those of the designs that were forged, on the mesh of the best one and within a tenth of the scales: what remeshing
    /// decides there may be far beyond the noise, which is measured over a hundredth of that.
    Neighbours neighbours() const;
    /// Returns whether the best design keeps a limit by less than what its neighbours are off by, as by luck: where that is
    /// more than half a percent of the bound and three times the noise.
    bool keeps_by_luck(const Limit &limit) const;
    /// Returns whether the best design could not be forged for the confirmation.
    bool fails_there() const { return confirmation && confirmation->best.failed(); }
    /// Returns whether the best design, forged for the confirmation, misses a limit, or any.
    bool misses_there(const Limit &limit) const;
    bool misses_there() const;
    /// Returns what such a limit counts from then on: what the finer mesh adds to the value, and for what that of another
    /// design differs by its tolerance or its noise, the larger of the two.
    double correction_there(const Limit &limit) const;
    /// Returns the number of designs tried since the last accepted one, if all of them failed.
    std::size_t n_failed_at_the_end() const;
    /// Returns whether steps became too short because designs around the last one failed.
    bool ended_among_failures() const;
    /// Returns whether intervals and multipliers mean something: the search came to an end by itself.
    bool has_converged() const;
    /// Returns whether no design but the first could be forged.
    bool found_nothing() const;

    /// Returns the exit status: 0, or 2 where no design keeps the limits, the best one misses them on the finer mesh or
    /// cannot be forged there, or none but the first could be forged.
    int exit_status() const
    {
      return limits_are_kept() && !misses_there() && !fails_there() && !found_nothing() ? 0 : 2;
    }

    /// Returns the total change of the objective by new meshes.
    double by_meshes() const;

    void write_csv(const std::string &file) const;
    void write_json(const std::string &file) const;
    void print(std::ostream &out) const;
    /// A line on a new mesh.
    void print(const NewMesh &mesh, std::ostream &out) const;

  private:
    /// Prints why the result cannot be used, before all numbers of it.
    void print_warning(std::ostream &out) const;
    void print_limits(std::ostream &out) const;
  };

  std::string in_words(DesignSpace::At at);
  std::string in_words(SearchStop stop);
  std::string in_words(TrialRow::Decision decision, bool failed);
} // namespace retroforge
