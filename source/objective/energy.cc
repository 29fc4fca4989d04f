// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/objective/energy.h>

namespace retroforge
{
  template <typename Number>
  std::vector<Number> EnergyObjective::compute_integrals(const EquilibriumView<Number> &view) const
  {
    const auto [deformation, friction] = view.stage.power(view.W, view.active);
    return {deformation, friction};
  }

  template std::vector<double> EnergyObjective::compute_integrals(const EquilibriumView<double> &) const;
  template std::vector<Dual>   EnergyObjective::compute_integrals(const EquilibriumView<Dual> &) const;

  std::pair<double, double> EnergyObjective::split(const PathRows<double> &rows)
  {
    std::pair<double, double> energy(0., 0.);
    for (const PathRow<double> &row : rows)
    {
      energy.first += row.dt * row.integrals[0];
      energy.second += row.dt * row.integrals[1];
    }
    return energy;
  }

  void EnergyObjective::reverse_integrals(const EquilibriumView<double> &view,
                                          const std::vector<double>     &weights,
                                          EquilibriumBar                &bar) const
  {
    reverse_power(view, weights[0], weights[1], bar);
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
