// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/material/damage_law.h>
#include <retroforge/steps/damage.h>

namespace retroforge
{
  namespace
  {
    template <typename Number>
    Number damage_rate(const CellStress<Number> &stress)
    {
      if (value_of(stress.rate) == 0.) // the law of metal at rest may have no stress
        return Number(0.);
      return latham_cockcroft_rate(stress.largest_principal_stress(), stress.flow_stress(), stress.rate);
    }
  } // namespace

  template <typename Number>
  void add_damage(const EquilibriumView<Number> &view, const Number &dt, std::vector<Number> &damage)
  {
    const Discretization<3> &discretization = view.stage.scene.discretization;
    AssertDimension(damage.size(), view.stage.scene.mesh.n_cells());
    for (const CellIndex c : discretization.cells().owned())
      damage[c] += view.weight * dt * damage_rate(cell_stress(view, c));
    complete_entries(discretization.cells(), damage.data(), 1);
  }

  template void add_damage(const EquilibriumView<double> &, const double &, std::vector<double> &);
  template void add_damage(const EquilibriumView<Dual> &, const Dual &, std::vector<Dual> &);

  void reverse_add_damage(const EquilibriumView<double> &view,
                          const double                   dt,
                          const std::vector<double>     &damage_bar,
                          EquilibriumBar                &bar)
  {
    const Discretization<3> &discretization = view.stage.scene.discretization;
    AssertDimension(damage_bar.size(), view.stage.scene.mesh.n_cells());
    for (const CellIndex c : discretization.cells().owned())
    {
      if (damage_bar[c] == 0.)
        continue;
      const CellStress<double> stress = cell_stress(view, c);
      const double             weight = view.weight * damage_bar[c];
      bar.physics.dt += weight * damage_rate(stress);
      const auto rate = [](const auto &at) { return damage_rate(at); };
      reverse_cell_stress(view, c, derivatives(weight * dt, rate, stress), bar);
    }
  }
} // namespace retroforge
