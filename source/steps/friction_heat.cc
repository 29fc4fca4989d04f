// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/rank_sum.h>
#include <retroforge/solver/contact_pullback.h>
#include <retroforge/steps/friction_heat.h>
#include <retroforge/steps/warming.h>

namespace retroforge
{
  namespace
  {
    template <typename Number>
    bool is_owned(const Equilibrium<Number> &stage, const unsigned int p)
    {
      return stage.scene.discretization.owns(stage.contact.pairs[p].point.nodes[0]);
    }

    /// Power of friction at all nodes [mJ/s]. Collective.
    template <typename Number>
    std::vector<Number> power_at_nodes(const EquilibriumView<Number> &view)
    {
      const Equilibrium<Number>   &stage = view.stage;
      RankSum<std::vector<Number>> power(std::vector<Number>(stage.scene.mesh.n_nodes(), Number(0.)),
                                         stage.scene.discretization.comm());
      for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
        if (is_owned(stage, p))
        {
          const ContactPoint &point    = stage.contact.pairs[p].point;
          const Number        of_point = friction_power(
            stage.contact_node(p, view.W, view.active), stage.surface_law(p), stage.physics.contact);
          for (unsigned int i = 0; i < point.n_nodes(); ++i)
            power.part()[point.nodes[i]] += point.weight() * of_point;
        }
      return power.complete();
    }
  } // namespace

  template <typename Number>
  void add_friction_heat(const EquilibriumView<Number> &view, const Number &dt, std::vector<Number> &T)
  {
    const TetMesh            &mesh = view.stage.scene.mesh;
    const HeatLaw<Number>    &heat = view.stage.physics.heat;
    const NodeVolumes<Number> volumes(mesh, view.stage.X);
    const std::vector<Number> power  = power_at_nodes(view);
    const Number              factor = 4. * view.weight * dt * heat.friction_part / heat.capacity;
    for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
      T[k] += factor * power[k] / volumes.of_node[k];
  }

  template void add_friction_heat(const EquilibriumView<double> &, const double &, std::vector<double> &);
  template void add_friction_heat(const EquilibriumView<Dual> &, const Dual &, std::vector<Dual> &);

  void reverse_add_friction_heat(const EquilibriumView<double> &view,
                                 const double                   dt,
                                 const std::vector<double>     &T_bar,
                                 EquilibriumBar                &bar)
  {
    const Equilibrium<double> &stage = view.stage;
    const TetMesh             &mesh  = stage.scene.mesh;
    const HeatLaw<double>     &heat  = stage.physics.heat;
    const NodeVolumes<double>  volumes(mesh, stage.X);
    const std::vector<double>  power = power_at_nodes(view);
    const double per_heat = 4. * view.weight / heat.capacity, factor = dt * per_heat * heat.friction_part;
    double       work_bar = 0.; // of what the warming is proportional to
    for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
      work_bar += T_bar[k] * power[k] / volumes.of_node[k];
    for (const CellIndex c : stage.scene.discretization.cells().owned())
    {
      double volume_bar = 0.;
      for (const NodeIndex k : mesh.cells[c])
        volume_bar -= T_bar[k] * power[k] / (volumes.of_node[k] * volumes.of_node[k]);
      reverse_cell_volume(mesh, stage.X, c, factor * volume_bar, bar.X);
    }
    RankSum<double> of_ranks(0., stage.scene.discretization.comm());
    of_ranks.add_once([&](double &part) { part = work_bar; });
    const double once = of_ranks.part();
    bar.physics.dt += per_heat * heat.friction_part * once;
    bar.physics.heat.friction_part += per_heat * dt * once;
    bar.physics.heat.capacity -= factor * once / heat.capacity;
    ContactPullback pullback(view, bar);
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
      if (is_owned(stage, p))
      {
        const ContactPoint &point     = stage.contact.pairs[p].point;
        double              power_bar = 0.;
        for (unsigned int i = 0; i < point.n_nodes(); ++i)
          power_bar += point.weight() * T_bar[point.nodes[i]] / volumes.of_node[point.nodes[i]];
        if (power_bar != 0.)
          pullback.add(p,
                       reverse_friction_power(stage.contact_node(p, view.W, view.active),
                                              stage.surface_law(p),
                                              stage.physics.contact,
                                              factor * power_bar));
      }
    pullback.finish();
  }
} // namespace retroforge
