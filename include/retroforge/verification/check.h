// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/adjoint/objective_sensitivity.h>
#include <retroforge/case/check_parameters.h>
#include <retroforge/design/design.h>
#include <retroforge/verification/difference_fit.h>

#include <functional>

namespace retroforge
{
  /// Evaluates the objectives at parameters mu, with billet and dies moved by `shift` from there: one number
  /// each.
  struct DifferenceEvaluator
  {
    using Values = std::vector<double>;

    /// Decides everything anew, but for increments that other designs repeat (Parameters::repeats_steps).
    std::function<Values(const std::vector<double> &mu, const ShapePerturbation &shift)> free;
    /// Obeys the recorded decisions.
    std::function<Values(const std::vector<double> &mu, const ShapePerturbation &shift)> replayed;
    /// The direct method, along (mu_dot, shift_dot).
    std::function<Values(const std::vector<double> &mu_dot, const ShapePerturbation &shift_dot)> tangent;
  };

  /// Differences at one step (relative to the parameter's scale).
  struct DifferenceRow
  {
    double step;
    double replayed_central, replayed_forward, replayed_backward, free_central;
  };

  /// One derivative seen from all sides.
  struct CheckRow
  {
    std::string                objective, parameter, unit;
    double                     adjoint, tangent;
    std::vector<DifferenceRow> steps;
    std::vector<double>        taylor_orders; ///< of the replayed remainder, one per halving
    bool                       passed;
    double                     magnitude        = 0.; ///< of the derivative but for cancellation, or 0
    double                     least_difference = 0.; ///< that differences are asked to resolve to the bar
    bool                       is_zero   = false; ///< the objective does not depend on it, but for rounding
    std::string                failed_by = {};    ///< in words; empty where it passed

    /// Against the larger of the derivative and its magnitude: in a direction along which the derivative
    /// cancels, rounding does not.
    double tangent_error() const;
    /// Smallest error of the replayed central differences, and of what two neighbouring steps extrapolate to,
    /// without the error in h^2: where the derivative nearly cancels, no step is small enough for that and
    /// large enough for rounding.
    double best_replayed_error() const;
    /// What the differences that decide everything anew, and those that replay, have in common; jumps over the
    /// value of the objective. Nothing is known of a derivative that is zero.
    DifferenceFit free_fit() const;
    DifferenceFit replayed_fit() const;
    /// Returns whether the slope of the differences that decide anew is known and more than half beside the
    /// adjoint: which of them the trend has is not known then. Where new meshes follow the shape, the adjoint is
    /// not theirs, and a check of it passes all the same.
    bool is_doubtful() const;
    /// Of the replayed central differences: no derivative is zero for which all of them are not.
    double smallest_difference() const;
  };

  /// Told before the first direction that is to be checked and after each: the rows so far, how many
  /// directions are done, and how many there are.
  using CheckWatch =
    std::function<void(const std::vector<CheckRow> &rows, unsigned int done, unsigned int all)>;

  /// Checks the derivative of each objective in each design parameter, along one random direction of all X_0,
  /// and along one of all vertices of each die that has some. Objectives share the runs. Rows are ordered by
  /// objective.
  /// @param done  rows of an earlier check of the same record, which stopped: their directions are not
  /// repeated
  std::vector<CheckRow> check_gradient(const CheckParameters                   &parameters,
                                       const Design                            &design,
                                       const std::vector<double>               &mu,
                                       const std::vector<ObjectiveSensitivity> &sensitivities,
                                       double                                   length,
                                       const DifferenceEvaluator               &evaluator,
                                       const std::vector<CheckRow>             &done,
                                       const CheckWatch                        &watch);

  /// Prints the table that a user reads.
  void print(const std::vector<CheckRow> &rows, std::ostream &out);
} // namespace retroforge
