// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/objective_type.h>
#include <retroforge/objective/path_objective.h>
#include <retroforge/solver/spent_power.h>

namespace retroforge
{
  /// Energy spent [mJ],
  ///   sum_i dt_i [ int s:eps + sum_k tau_k·dv_k S^f_k + w_i sum_k N_k u_k ],
  /// as the equilibrium has stress and friction, regularisations included, and what these lack where gaps close
  /// (spent_power.h). The integrals are the terms of the power.  @cite Laroussi2003, Eq. (97)-(98), but for the
  /// last part
  class EnergyObjective : public PathObjectiveOf<EnergyObjective>
  {
  public:
    static constexpr unsigned int n_terms = 1;

    std::string name() const override { return "energy"; }
    std::string unit() const override { return "mJ"; }
    bool        is_of_forces() const override { return true; }

    /// Returns what went into deformation and into friction [mJ].
    static EnergyParts<double> split(const PathRows<double> &rows);

    std::map<std::string, double> parts(const PathRows<double> &rows) const override
    {
      const auto [deformation, friction, closing] = split(rows);
      return {{"deformation", deformation}, {"friction", friction}, {"closing", closing}};
    }

    void reverse_integrals(const EquilibriumView<double> &view,
                           const std::vector<double>     &weights,
                           EquilibriumBar                &bar) const override;

    template <typename Number>
    std::vector<Number> compute_integrals(const EquilibriumView<Number> &view) const;

    template <typename Number>
    std::vector<Number> terms(const PathRow<Number> &row, double) const
    {
      return {Number(row.dt * spent_power(row.integrals).total())};
    }

    template <typename Number>
    Number combine(const std::vector<Number> &sums, double) const
    {
      return sums[0];
    }
  };

  /// Returns the type of this objective, as parameter files offer it.
  Choice<ObjectiveType>::Maker energy_type();
} // namespace retroforge
