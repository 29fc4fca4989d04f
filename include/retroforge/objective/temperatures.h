// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/final_objective.h>
#include <retroforge/objective/objective_type.h>
#include <retroforge/objective/smooth_maximum.h>

/// @file
/// Extremes of the temperature of the workpiece after the stroke [C]. The largest is the ExponentialMean over the nodes,
///   ( sum_k V_k T_k exp(T_k/s) ) / ( sum_k V_k exp(T_k/s) ),  V_k the volume of the cells at node k;
/// the least is that of -T, the spread their difference.
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
        : extreme_(extreme), hottest_{smoothing}, coldest_{-smoothing}
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
    std::array<Number, 4> terms(const Number &T, const Decisions &decisions) const
    {
      const auto hot = hottest_.terms(T, decisions.largest), cold = coldest_.terms(T, decisions.least);
      return {{hot[0], hot[1], cold[0], cold[1]}};
    }

    TemperatureExtreme extreme_;
    ExponentialMean    hottest_, coldest_;
  };

  /// Return the types of these objectives, as parameter files offer them.
  Choice<ObjectiveType>::Maker largest_temperature_type();
  Choice<ObjectiveType>::Maker least_temperature_type();
  Choice<ObjectiveType>::Maker temperature_spread_type();
} // namespace retroforge
