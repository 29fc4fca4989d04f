// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/case/optimization_parameters.h>
#include <retroforge/objective/objectives.h>

namespace retroforge
{
  /// A limit of an objective, as a number without unit that may not be positive:
  /// c = (value + correction - bound) / size,  or (bound - value - correction) / size where the value may not be
  /// smaller.
  struct Limit
  {
    unsigned int objective;
    double       bound;
    bool         at_least;
    double       size = 1.; ///< the bound's, or the value's at the start where the bound is 0
    /// What a finer mesh adds to the value, as far as the limit counts it [the objective's unit].
    double correction = 0.;

    /// The value as the limit counts it.
    double counted(const std::vector<double> &values) const { return values[objective] + correction; }
    double excess(const std::vector<double> &values) const { return excess_of(counted(values)); }
    /// Of a value that needs no correction.
    double excess_of(const double value) const { return (at_least ? bound - value : value - bound) / size; }
    /// dc/d(value).
    double slope() const { return (at_least ? -1. : 1.) / size; }
  };

  /// A measured value of an objective, and its standard deviation.
  struct Datum
  {
    unsigned int objective;
    double       value, deviation;

    /// Returns the misfit of a forging, in deviations.
    double misfit(const std::vector<double> &values) const { return (values[objective] - value) / deviation; }
  };

  /// The objective to minimise, and the limits, among all objectives of a case: a weighted sum of some, or
  /// the misfit of data,  sum_i ((v_i - d_i) / s_i)^2 / 2.
  struct Criteria
  {
    Combination        objective; ///< without weights where there are data
    std::vector<Datum> data;
    std::vector<Limit> limits;

    /// @throws Error  for a name that is not among the objectives; nothing to make small; a limit twice
    Criteria(const Objectives &objectives, const OptimizationParameters &parameters);
    /// A value that is told behind those of all objectives, with limits where these are finite.
    void add_value(double least, double most);
    /// Sizes of limits that are 0.
    void set_sizes(const std::vector<double> &start);

    double value(const std::vector<double> &values) const;
    /// Derivative by the values of all objectives.
    std::vector<double> slopes(const std::vector<double> &values) const;

    /// As a limit or as data.
    bool   uses(unsigned int o) const;
    double largest_excess(const std::vector<double> &values) const;
  };

  /// The augmented Lagrangian  (f - f_0) / size + sum_i ([lambda_i + rho_i c_i]_+^2 - lambda_i^2) / (2 rho_i).
  struct Merit
  {
    const Criteria     *criteria;
    double              origin = 0., size = 1.;
    std::vector<double> multipliers; ///< one per limit, not negative
    std::vector<double> penalties;   ///< rho_i, one per limit, positive

    /// Returns  [lambda_i + rho_i c_i]_+.
    double pressed(std::size_t limit, const std::vector<double> &values) const;
    /// Returns what limit i adds where it is exceeded by c:  ([lambda_i + rho_i c]_+^2 - lambda_i^2) / (2 rho_i).
    double term(std::size_t limit, double excess) const;
    double value(const std::vector<double> &values) const;
    /// Derivative of the merit by a parameter, from those of all objectives.
    /// @param gradients  of each objective
    std::vector<double> gradient(const std::vector<double>              &values,
                                 const std::vector<std::vector<double>> &gradients) const;
  };

  /// lambda >= 0 with the least  |g + sum_i lambda_i c_i|,  g and c_i over variables that no bound holds.
  /// @param columns  c_i; those of limits that are far from their bounds are left out by the caller
  std::vector<double> least_squares_multipliers(const std::vector<double>              &g,
                                                const std::vector<std::vector<double>> &columns);
} // namespace retroforge
