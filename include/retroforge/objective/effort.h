// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/fitted_maximum.h>
#include <retroforge/objective/objective_type.h>
#include <retroforge/objective/path_objective.h>

#include <limits>

/// @file
/// The force that the press must bring up, averaged over a window of the run or its maximum there.
namespace retroforge
{
  /// A part of the run, by time or by stroke, from the start of the first operation's. An increment counts with that part
  /// of it that lies inside.
  /// Times follow the die's speed, strokes the state where ends of increments do (steps/moved_ends.h), and so does
  /// an increment's part of a window, with a kink where an increment begins or ends on the window's edge.
  struct PathWindow
  {
    enum class Over
    {
      time,  ///< [s]
      stroke ///< [mm]
    };

    Over   over  = Over::stroke;
    double begin = 0.;
    double end   = std::numeric_limits<double>::max();

    /// @throws Error
    void check(const std::string &where) const;

    /// Returns the length of the increment's part inside [s or mm].
    template <typename Number>
    Number overlap(const PathRow<Number> &row) const;

    /// Returns the time of the increment's part inside [s], in an increment of stroke by the share of its stroke.
    template <typename Number>
    Number time_inside(const PathRow<Number> &row) const;
  };

  /// The force of one increment [N].
  class Effort
  {
  public:
    enum class By
    {
      power, ///< the power spent (spent_power.h) over |v_die|
      force ///< force of the die on the workpiece along its velocity, contact and friction: a part of the same
    };

    /// @param die  the one that moves
    explicit Effort(const unsigned int die, const By by = By::power) : die_(die), by_(by) {}

    /// Returns what a stage contributes to what the force follows from, this rank's part: the terms of the
    /// power, the die's speed, 0 where it is not in the press, and the power of the die where it is asked for.
    template <typename Number>
    std::vector<Number> terms(const EquilibriumView<Number> &view) const;

    /// Adds the derivatives of  weights·terms,  this rank's part.
    void reverse_terms(const EquilibriumView<double> &view,
                       const std::vector<double>     &weights,
                       EquilibriumBar                &bar) const;

    /// Returns the force of an increment with these terms [N].
    template <typename Number>
    Number force(const std::vector<Number> &terms) const;

    /// Returns an increment's part of a window, of those in which the die stands in the press: 0 in other operations.
    template <typename Number>
    Number length(const PathRow<Number> &row, const PathWindow &window) const;

  private:
    unsigned int die_;
    By           by_;
  };

  /// Mean effort over a window [N],  sum_i F_i l_i / sum_i l_i,  l_i the increment's part of the window. By
  /// power and with one moving die it is the mean of that die's force. @cite Laroussi2003, Eq. (99), (120)
  class MeanEffort : public PathObjectiveOf<MeanEffort>
  {
  public:
    static constexpr unsigned int n_terms = 2;

    MeanEffort(const Effort &effort, const PathWindow &window);

    std::string name() const override { return "mean effort"; }
    std::string unit() const override { return "N"; }
    bool        is_of_forces() const override { return true; }

    void reverse_integrals(const EquilibriumView<double> &view,
                           const std::vector<double>     &weights,
                           EquilibriumBar                &bar) const override;

    template <typename Number>
    std::vector<Number> compute_integrals(const EquilibriumView<Number> &view) const;
    template <typename Number>
    std::vector<Number> terms(const PathRow<Number> &row, double) const;
    template <typename Number>
    Number combine(const std::vector<Number> &sums, double) const;

  private:
    Effort     effort_;
    PathWindow window_;
  };

  /// Largest effort over a window [N], of forces that are fitted along the path of the press
  /// (fitted_maximum.h), increments weighted with their part of the window. Each operation is a path of its
  /// own.  @cite Laroussi2003, Eq. (100), for what it measures
  class MaximumEffort : public PathIntegralsOf<MaximumEffort>
  {
  public:
    static constexpr double default_reach = 0.08;

    /// @param reach  of the fits, a part of the path that lies in the window; 0: forces as they are  @throws Error
    MaximumEffort(const Effort        &effort,
                  const PathWindow    &window,
                  const SmoothMaximum &maximum,
                  double               reach = default_reach);

    std::string name() const override { return "maximum effort"; }
    std::string unit() const override { return "N"; }
    bool        is_of_forces() const override { return true; }

    /// Returns the largest effort of an increment in the window [N]; 0 if there is none.
    double true_maximum(const PathRows<double> &rows) const;

    std::map<std::string, double> details(const PathRows<double> &rows) const override
    {
      return {{"true maximum", true_maximum(rows)}};
    }

    double value(const PathRows<double> &rows) const override { return evaluate(rows); }
    Dual   value(const PathRows<Dual> &rows) const override { return evaluate(rows); }

    PathRows<double> reverse_value(const PathRows<double> &rows) const override;

    void reverse_integrals(const EquilibriumView<double> &view,
                           const std::vector<double>     &weights,
                           EquilibriumBar                &bar) const override;

    template <typename Number>
    std::vector<Number> compute_integrals(const EquilibriumView<Number> &view) const;

  private:
    template <typename Number>
    Number evaluate(const PathRows<Number> &rows) const;

    /// Returns the rows in the window.
    template <typename Number>
    ForcePath<Number> path_of(const PathRows<Number> &rows) const;

    Effort        effort_;
    PathWindow    window_;
    FittedMaximum maximum_;
    double        reach_;
  };

  /// Return the types of these objectives, as parameter files offer them.
  Choice<ObjectiveType>::Maker mean_effort_type();
  Choice<ObjectiveType>::Maker maximum_effort_type();
} // namespace retroforge
