// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/final_objective.h>
#include <retroforge/objective/objective_type.h>
#include <retroforge/objective/smooth_maximum.h>

namespace retroforge
{
  enum class DamageStatistic
  {
    largest, ///< smooth maximum over the volume
    mean     ///< int D / V
  };

  /// Damage of the metal at the end (steps/damage.h), dimensionless; cells weighted with their volume at X_N.
  class DamageObjective : public FinalObjectiveOf<DamageObjective>
  {
  public:
    /// @param smooth  of the largest one, and else ignored   @throws Error
    explicit DamageObjective(DamageStatistic statistic, const SmoothMaximum &smooth = {});

    std::string name() const override { return "damage"; }
    std::string unit() const override { return "none"; }

    /// The true maximum, by which values are divided before they are summed; the objective does not depend on it.
    struct Decisions
    {
      double largest;
    };
    Decisions compute_decisions(const FinalView<double> &view) const;

    /// Returns the true maximum.
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
    /// Returns what is integrated of a cell's damage.
    template <typename Number>
    Number integrand(const Number &damage, const Decisions &decisions) const
    {
      return statistic_ == DamageStatistic::mean ? damage
                                                 : smooth_.term(damage, Number(1.), decisions.largest);
    }

    DamageStatistic statistic_;
    SmoothMaximum   smooth_;
  };

  /// Returns the type of this objective, as parameter files offer it.
  Choice<ObjectiveType>::Maker damage_type();
} // namespace retroforge
