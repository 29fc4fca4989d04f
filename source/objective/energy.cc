// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/objective/energy.h>

namespace retroforge
{
  template <typename Number>
  std::vector<Number> EnergyObjective::compute_integrals(const EquilibriumView<Number> &view) const
  {
    return power_terms(view);
  }

  template std::vector<double> EnergyObjective::compute_integrals(const EquilibriumView<double> &) const;
  template std::vector<Dual>   EnergyObjective::compute_integrals(const EquilibriumView<Dual> &) const;

  EnergyParts<double> EnergyObjective::split(const PathRows<double> &rows)
  {
    EnergyParts<double> energy;
    for (const PathRow<double> &row : rows)
    {
      const auto power = spent_power(row.integrals);
      energy.deformation += row.dt * power.deformation;
      energy.friction += row.dt * power.friction;
      energy.closing += row.dt * power.closing;
    }
    return energy;
  }

  void EnergyObjective::reverse_integrals(const EquilibriumView<double> &view,
                                          const std::vector<double>     &weights,
                                          EquilibriumBar                &bar) const
  {
    reverse_power_terms(view, weights, bar);
  }

  namespace
  {
    struct EnergyType : ObjectiveType
    {
      void make(const std::string &, const ObjectiveContext &, NamedObjective &objective) const override
      {
        objective.scaling = SymmetryScaling::part;
        objective.path    = std::make_unique<EnergyObjective>();
      }
    };
  } // namespace

  Choice<ObjectiveType>::Maker energy_type()
  {
    return {"energy", Choice<ObjectiveType>::make<EnergyType>};
  }
} // namespace retroforge
