// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/objective/contact_pullback.h>
#include <retroforge/objective/energy.h>

namespace retroforge
{
  template <typename Number>
  std::vector<Number> EnergyObjective::compute_integrals(const StageView<Number> &view) const
  {
    const auto [deformation, friction] = view.stage.power(view.W, view.active);
    return {deformation, friction};
  }

  template std::vector<double> EnergyObjective::compute_integrals(const StageView<double> &) const;
  template std::vector<Dual>   EnergyObjective::compute_integrals(const StageView<Dual> &) const;

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

  void EnergyObjective::reverse_integrals(const StageView<double>   &view,
                                          const std::vector<double> &weights,
                                          StageBar                  &bar) const
  {
    reverse_powers(view, weights[0], weights[1], bar);
  }

  void reverse_powers(const StageView<double> &view,
                      const double             deformation,
                      const double             friction,
                      StageBar                &bar)
  {
    const Stage<double> &stage = view.stage;
    reverse_power(stage, view.W, view.active, deformation, bar.W, bar.X, bar.contact, bar.physics, bar.shape);
    if (friction == deformation)
      return;
    ContactPullback pullback(view, bar);
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
      if (stage.scene.partition.owns(stage.contact.pairs[p].point.nodes[0]))
        pullback.add(p,
                     reverse_friction_power(stage.contact_node(p, view.W, view.active),
                                            stage.physics.law,
                                            stage.physics.contact,
                                            friction - deformation));
    pullback.finish();
  }
} // namespace retroforge
