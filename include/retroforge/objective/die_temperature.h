// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/final_objective.h>
#include <retroforge/objective/objective_type.h>
#include <retroforge/objective/smooth_maximum.h>

namespace retroforge
{
  /// The largest temperature of a die's surface, beneath the metal that touches it at the end [C]: the mean
  ///   ( sum_k A_k t_k exp(t_k/s) ) / ( sum_k A_k exp(t_k/s) ),
  /// t_k the temperature of the surface at node k (heat/surface_temperature.h), A_k the area there that touches the die. That of
  /// the die itself where nothing does.
  class DieTemperature : public FinalObjectiveOf<DieTemperature>
  {
  public:
    /// @param smoothing  s [K]
    DieTemperature(const unsigned int die, const double smoothing) : die_(die), mean_{smoothing} {}

    std::string name() const override { return "die temperature"; }
    std::string unit() const override { return "C"; }

    /// The true maximum, to which exponents are taken; the value does not depend on it.
    struct Decisions
    {
      double largest;
    };
    Decisions compute_decisions(const FinalView<double> &view) const;

    /// Returns the true maximum.
    std::map<std::string, double> details(const std::vector<double> &,
                                          const FinalDecisions &decisions) const override;

    /// The sums of the mean, and the temperature of the die itself.
    template <typename Number>
    std::vector<Number> compute_integrals(const FinalView<Number> &view, const Decisions &decisions) const;
    template <typename Number>
    Number combine(const std::vector<Number> &integrals, const Decisions &decisions) const;

    void reverse_integrals(const FinalView<double>   &view,
                           const Decisions           &decisions,
                           const std::vector<double> &weights,
                           FinalBar                  &bar) const;

  private:
    unsigned int    die_;
    ExponentialMean mean_;
  };

  /// Returns the type of this objective, as parameter files offer it.
  Choice<ObjectiveType>::Maker die_temperature_type();
} // namespace retroforge
