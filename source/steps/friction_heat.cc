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

  namespace
  {
    /// Of a node's surface the part that does not touch a die counts as this much.
    constexpr double beside = 0.1;

    /// At all nodes.
    template <typename Number>
    struct RubbedNodes
    {
      std::vector<Number> power;    ///< [mJ/s]
      std::vector<Number> touching; ///< sum of S^f over dies [mm^2]
      std::vector<Number> surface;  ///< sum of S over dies
      std::vector<double> n_dies;

      static RubbedNodes none(const std::size_t n)
      {
        const std::vector<Number> zero(n, Number(0.));
        return {zero, zero, zero, std::vector<double>(n, 0.)};
      }

      template <typename Self>
      static auto members(Self &self)
      {
        auto &[power, touching, surface, n_dies] = self;
        return std::tie(power, touching, surface, n_dies);
      }

      bool touches(const NodeIndex k) const { return value_of(touching[k]) > 0.; }

      /// Of the node's part of the surface, that counts for the flux [mm^2].
      Number area(const NodeIndex k) const
      {
        return (1. - beside) * touching[k] + beside * surface[k] / n_dies[k];
      }
    };

    /// Collective.
    template <typename Number>
    RubbedNodes<Number> rubbed_nodes(const EquilibriumView<Number> &view)
    {
      const Equilibrium<Number>   &stage = view.stage;
      RankSum<RubbedNodes<Number>> nodes(RubbedNodes<Number>::none(stage.scene.mesh.n_nodes()),
                                         stage.scene.discretization.comm());
      for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
        if (is_owned(stage, p) && stage.contact.pairs[p].point.is_node())
        {
          const NodeIndex           k    = stage.contact.pairs[p].point.nodes[0];
          const ContactNode<Number> node = stage.contact_node(p, view.W, view.active);
          nodes.part().power[k] += friction_power(node, stage.surface_law(p), stage.physics.contact);
          nodes.part().touching[k] += node.Sf;
          nodes.part().surface[k] += node.S;
          nodes.part().n_dies[k] += 1.;
        }
      return nodes.complete();
    }
  } // namespace

  template <typename Number>
  void add_friction_flux(const EquilibriumView<Number> &view, std::vector<Number> &flux)
  {
    const auto nodes = rubbed_nodes(view);
    for (NodeIndex k = 0; k < flux.size(); ++k)
      if (nodes.touches(k))
        flux[k] += view.weight * nodes.power[k] / nodes.area(k);
  }

  template void add_friction_flux(const EquilibriumView<double> &, std::vector<double> &);
  template void add_friction_flux(const EquilibriumView<Dual> &, std::vector<Dual> &);

  void reverse_add_friction_flux(const EquilibriumView<double> &view,
                                 const std::vector<double>     &flux_bar,
                                 EquilibriumBar                &bar)
  {
    const Equilibrium<double> &stage = view.stage;
    const auto                 nodes = rubbed_nodes(view);
    ContactPullback            pullback(view, bar);
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
    {
      const ContactPoint &point = stage.contact.pairs[p].point;
      const NodeIndex     k     = point.nodes[0];
      if (!is_owned(stage, p) || !point.is_node() || !nodes.touches(k) || flux_bar[k] == 0.)
        continue;
      const double area = nodes.area(k), power_bar = view.weight * flux_bar[k] / area,
                   area_bar   = -power_bar * nodes.power[k] / area;
      ContactNodeBar node_bar = reverse_friction_power(
        stage.contact_node(p, view.W, view.active), stage.surface_law(p), stage.physics.contact, power_bar);
      node_bar.Sf += (1. - beside) * area_bar;
      node_bar.S += beside * area_bar / nodes.n_dies[k];
      pullback.add(p, node_bar);
    }
    pullback.finish();
  }
} // namespace retroforge
