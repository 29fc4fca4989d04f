// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/optimization/design_space.h>
#include <retroforge/optimization/journal.h>
#include <retroforge/optimization/local_model.h>
#include <retroforge/optimization/merit.h>
#include <retroforge/optimization/minimize.h>

#include <optional>

namespace retroforge
{
  /// Why a search ended, or that it goes on.
  enum class SearchStop
  {
    running,
    gradient,
    noise,
    step,
    gains,  ///< of the last designs are little, as along a kink
    limits, ///< which are not met, and no penalty makes the design meet them
    iterations,
    simulations,
    mesh ///< which is to be made anew before the search goes on
  };

  /// Functions that a search evaluates, and observers that it notifies.
  struct SearchTask
  {
    using Forging = std::function<Evaluation(const std::vector<double> &mu)>;

    Forging                       evaluate;      ///< values, or why there are none
    Forging                       differentiate; ///< forges a design whose values are finite, with gradients
    std::function<unsigned int()> n_evaluated;   ///< designs so far, however often each was asked for
    /// Called for each design that was tried, after its values.
    std::function<void(const Evaluation &evaluation, bool accepted)> decided;
    /// Multipliers are renewed, and a round begins. @param excess  the largest one of the limits
    std::function<void(double excess)> renewed;
    /// Whether forgings should go on with another mesh, asked after each step at the design accepted last;
    /// null: never.
    std::function<bool(const Evaluation &now)> mesh_is_bad = {};
    /// Changes to that mesh. @return the same design on it, with gradients; nothing where it stays as it was,
    /// of which mesh_is_bad() then says no more at this design
    std::function<std::optional<Evaluation>(const Evaluation &now)> renew_mesh = {};
  };

  /// The design with the least objective within bounds, relations and limits. Limits are kept by an augmented
  /// Lagrangian, minimized between bounds again and again, with multipliers that fit the gradients best at
  /// the end of each minimisation.
  class Search
  {
  public:
    /// Arguments passed by reference must live as long.
    Search(const DesignSpace            &space,
           const Criteria               &criteria,
           const OptimizationParameters &parameters,
           SearchTask                    task);

    /// Takes the sizes of the merit and of the penalty from the start. @param start  with gradients
    void begin(const Evaluation &start);

    /// The merit's gradient along a direction that is free both ways, against central differences.
    std::vector<DifferenceCheck> check();

    /// @param noise      of the objective, in its unit
    /// @param of_values  that of each value; empty: 0. That of a limit counts as far as the limit presses.
    void set_noise(double noise, std::vector<double> of_values = {});

    /// The noise of the merit at the design accepted last.
    double noise() const;

    /// Goes on from the design accepted last.
    /// @return whether limits are kept by the last one, and no multiplier would change it
    bool run();

    SearchStop        stop() const { return stop_; }
    const Evaluation &now() const { return now_; } ///< the design accepted last, with gradients
    double            radius() const { return radius_; }
    unsigned int      n_iterations() const { return iterations_; }
    /// Returns what designs are compared by; infinite where the forging failed.
    double merit_of(const Evaluation &evaluation) const;
    /// Returns the multipliers of the limits, in the objective's unit per unit of their excess.
    std::vector<double> multipliers() const;

  private:
    /// The merit over scaled variables, from the present design.
    BoundedProblem problem();
    /// Returns the length of a gradient over scaled variables, without parameters that the search does not
    /// vary.
    double varied_length(const std::vector<double> &by_mu) const;
    /// The penalty that curves the merit by ten times as much as its first guess, across this limit at the
    /// present design: how large a limit's unit is, as that of temperatures, has no say. None where it is not
    /// felt.
    std::optional<double> curving_penalty(const Limit &limit) const;
    /// Lets penalties of limits grow that a round has not brought nearer.
    /// @param before  excesses of the limits before it
    /// @param least   the first penalties
    /// @return whether any has
    bool raise_penalties(const std::vector<double> &before, const std::vector<double> &least);
    /// One minimisation with the multipliers there are; from the present design, to the last accepted one.
    /// Where the mesh is made anew it begins again there: with values of the new mesh, and all that was
    /// learned of the Hessian, which other chords of the same shape change little.
    void minimize_merit();
    void minimize_on_one_mesh();
    bool go_on(const MinimizerState &state);
    /// Returns whether the last eight designs have gained less than is asked for.
    bool gains_little() const;
    /// The merit at the present design, over scaled variables: data and limits are its terms.
    Linearization linearization() const;
    /// What of the noise of the merit comes by limits.
    double noise_of_limits() const;
    /// What the merit falls by along its gradient, per length, where no bound is in the way: of limits that press hard
    /// the projected gradient says only how far bounds are.
    double descent() const;
    /// Limits whose penalty is felt at the present design.
    std::vector<unsigned int> pressing() const;
    /// Multipliers that fit the gradients at the present design.
    std::vector<double> fitted_multipliers() const;
    bool                limits_are_settled(const std::vector<double> &multipliers) const;

    const DesignSpace            &space_;
    const Criteria               &criteria_;
    const OptimizationParameters &parameters_;
    const SearchTask              task_;

    Merit      merit_;
    Minimizer  minimizer_;
    Evaluation now_;
    /// Variables of the present design, as it was tried: its values come back bit for bit.
    BoundedProblem::Vector x_;
    double                 noise_ = 0.;  ///< of the objective, in units of the merit
    std::vector<double>    value_noise_; ///< of each value, or empty
    double                 radius_     = 0.;
    double                 begun_with_ = 0.; ///< the merit's gradient where the present round began
    unsigned int           iterations_ = 0;  ///< designs tried, without those known before
    unsigned int           begun_at_   = 0;  ///< how many there were then
    unsigned int           n_designs_  = 0;  ///< evaluated, as of the last iteration
    unsigned int           n_repeated_ = 0;  ///< iterations in a row whose design was known before
    std::vector<double>    merits_; ///< of the present round, of the design accepted last before each new one
    SearchStop             stop_ = SearchStop::running;
  };
} // namespace retroforge
