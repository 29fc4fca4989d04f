// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/final_objective.h>
#include <retroforge/objective/objective_type.h>

/// @file
/// Extremes of the temperature of the workpiece after the stroke [C]. The largest is a mean over the nodes,
///   ( sum_k V_k T_k exp(T_k/s) ) / ( sum_k V_k exp(T_k/s) ),  V_k the volume of the cells at node k,
/// which lies below it by about 1.5 s where a hot spot is round; the least is that of -T, the spread their
/// difference.
namespace retroforge
{
  enum class TemperatureExtreme
  {
    largest,
    least,
    spread
  };

  class TemperatureObjective : public FinalObjectiveOf<TemperatureObjective>
  {
  public:
    /// @param smoothing  s [K]
    TemperatureObjective(TemperatureExtreme extreme, double smoothing)
        : extreme_(extreme), smoothing_(smoothing)
    {
    }

    std::string name() const override;
    std::string unit() const override { return extreme_ == TemperatureExtreme::spread ? "K" : "C"; }

    /// The true extremes, to which exponents are taken; the value does not depend on them.
    struct Decisions
    {
      double largest, least;
    };
    Decisions compute_decisions(const FinalView<double> &view) const;

    /// Returns the true extreme beside the smooth one.
    std::map<std::string, double> details(const std::vector<double> &,
                                          const FinalDecisions &decisions) const override;

    template <typename Number>
    std::vector<Number> compute_integrals(const FinalView<Number> &view, const Decisions &decisions) const;
    template <typename Number>
    Number combine(const std::vector<Number> &integrals, const Decisions &decisions) const;

    void reverse_integrals(const FinalView<double>   &view,
                           const Decisions           &decisions,
                           const std::vector<double> &weights,
                           FinalBar                  &bar) const;

  private:
    /// What is summed of a node: weights of hot and of cold, and the same times the distance from the extreme.
    template <typename Number>
    std::array<Number, 4> terms(const Number &T, const Decisions &decisions) const;
    /// Returns the derivatives of terms() in T.
    std::array<double, 4> slopes(double T, const Decisions &decisions) const;

    TemperatureExtreme extreme_;
    double             smoothing_;
  };

  /// Return the types of these objectives, as parameter files offer them.
  Choice<ObjectiveType>::Maker largest_temperature_type();
  Choice<ObjectiveType>::Maker least_temperature_type();
  Choice<ObjectiveType>::Maker temperature_spread_type();
} // namespace retroforge
