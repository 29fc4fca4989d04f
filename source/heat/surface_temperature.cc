// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/heat/node_skins.h>
#include <retroforge/heat/surface_temperature.h>

namespace retroforge
{
  namespace
  {
    /// What the temperatures at a node's surface depend on.
    template <typename Number>
    struct SurfaceArguments
    {
      SkinArguments<Number> skin;
      Number                T, partner; ///< of the metal beneath, and of the dies [C]

      template <typename Self>
      static auto members(Self &self)
      {
        auto &[skin, T, partner] = self;
        return std::tie(skin, T, partner);
      }
    };

    /// Of the metal, and of the dies.
    template <typename Number>
    std::array<Number, 2> at_surface(const SurfaceArguments<Number> &of)
    {
      const auto   drops = drops_at(of.skin);
      const Number flux  = (of.T - of.partner) / drops.all; // over the film
      const Number die   = of.partner + flux * drops.die;
      return {{Number(die + flux), die}};
    }

    /// The mean temperature of the dies that each node touches.
    template <typename Number>
    std::vector<Number> partners(const HeatFlow<Number> &flow, const NodeContacts<Number> &touching)
    {
      std::vector<Number> mean(flow.network.volumes.size(), Number(0.));
      for (const auto &at : flow.surface.touching)
        if (value_of(at.weight) > 0.)
          mean[at.node] += at.weight / touching.weight[at.node] * flow.dies[at.die].temperature;
      return mean;
    }

    template <typename Number>
    SurfaceArguments<Number> surface_arguments(const HeatFlow<Number>          &flow,
                                               const NodeIndex                  k,
                                               const NodeContacts<Number>      &touching,
                                               const std::vector<Number>       &partner,
                                               const std::vector<Number>       &T,
                                               const std::vector<Skin<Number>> &skin)
    {
      return {skin_arguments(flow, k, touching, skin[k]), T[k], partner[k]};
    }

    /// The nodes of a face that touches.
    template <typename Number>
    std::array<NodeIndex, 3> nodes_of(const ThermalSurface<Number> &surface, const TouchingFace<Number> &face)
    {
      return {{surface.touching[face.corners[0]].node,
               surface.touching[face.corners[1]].node,
               surface.touching[face.corners[2]].node}};
    }

    /// At each node with a film the mean of its faces, by what of them touches, of the means of their nodes.
    template <typename Number>
    std::vector<Number>
    mean_over_faces(const HeatFlow<Number> &flow, const NodeContacts<Number> &touching, std::vector<Number> x)
    {
      std::vector<Number> sum(x.size(), Number(0.));
      for (const auto &face : flow.surface.faces)
      {
        const auto nodes = nodes_of(flow.surface, face);
        Number     mean(0.);
        for (const NodeIndex k : nodes)
          mean += x[k] / 3.;
        for (const NodeIndex k : nodes)
          sum[k] += face.area * mean;
      }
      for (NodeIndex k = 0; k < x.size(); ++k)
        if (touching.has_film(flow, k))
          x[k] = sum[k] / touching.area[k];
      return x;
    }

    /// Reverse of mean_over_faces(): returns the derivatives in x.
    std::vector<double> reverse_mean_over_faces(const HeatFlow<double>     &flow,
                                                const NodeContacts<double> &touching,
                                                const std::vector<double>  &x,
                                                const std::vector<double>  &mean_bar,
                                                NodeContactsBar            &nodes_bar,
                                                HeatFlowBar                &bar)
    {
      const std::vector<double> means = mean_over_faces(flow, touching, x);
      std::vector<double>       x_bar(x.size(), 0.), sum_bar(x.size(), 0.);
      for (NodeIndex k = 0; k < x.size(); ++k)
        if (touching.has_film(flow, k))
        {
          sum_bar[k] = mean_bar[k] / touching.area[k];
          nodes_bar.area[k] -= sum_bar[k] * means[k];
        }
        else
          x_bar[k] = mean_bar[k];
      for (std::size_t f = 0; f < flow.surface.faces.size(); ++f)
      {
        const auto  &face  = flow.surface.faces[f];
        const auto   nodes = nodes_of(flow.surface, face);
        const double sums  = sum_bar[nodes[0]] + sum_bar[nodes[1]] + sum_bar[nodes[2]];
        for (const NodeIndex k : nodes)
        {
          bar.surface.face_area[f] += sums * x[k] / 3.;
          x_bar[k] += sums * face.area / 3.;
        }
      }
      return x_bar;
    }

    /// At the nodes themselves.
    template <typename Number>
    std::array<std::vector<Number>, 2> nodal_surfaces(const HeatFlow<Number>          &flow,
                                                      const NodeContacts<Number>      &touching,
                                                      const std::vector<Number>       &partner,
                                                      const std::vector<Number>       &T,
                                                      const std::vector<Skin<Number>> &skin)
    {
      std::vector<Number> metal = T, die(T.size(), Number(0.));
      for (NodeIndex k = 0; k < T.size(); ++k)
        if (touching.has_film(flow, k))
        {
          const auto both = at_surface(surface_arguments(flow, k, touching, partner, T, skin));
          metal[k]        = both[0];
          die[k]          = both[1];
        }
      return {{std::move(metal), std::move(die)}};
    }
  } // namespace

  template <typename Number>
  std::array<std::vector<Number>, 2> surface_temperatures(const HeatFlow<Number>          &flow,
                                                          const std::vector<Number>       &T,
                                                          const std::vector<Skin<Number>> &skin)
  {
    AssertDimension(T.size(), flow.network.volumes.size());
    AssertDimension(skin.size(), T.size());
    const NodeContacts<Number> touching(flow);
    auto [metal, die] = nodal_surfaces(flow, touching, partners(flow, touching), T, skin);
    return {
      {mean_over_faces(flow, touching, std::move(metal)), mean_over_faces(flow, touching, std::move(die))}};
  }

  template std::array<std::vector<double>, 2> surface_temperatures(const HeatFlow<double> &,
                                                                   const std::vector<double> &,
                                                                   const std::vector<Skin<double>> &);
  template std::array<std::vector<Dual>, 2>
  surface_temperatures(const HeatFlow<Dual> &, const std::vector<Dual> &, const std::vector<Skin<Dual>> &);

  void reverse_surface_temperatures(const HeatFlow<double>                   &flow,
                                    const std::vector<double>                &T,
                                    const std::vector<Skin<double>>          &skin,
                                    const std::array<std::vector<double>, 2> &surfaces_bar,
                                    std::vector<double>                      &T_bar,
                                    std::vector<Skin<double>>                &skin_bar,
                                    HeatFlowBar                              &bar)
  {
    const NodeContacts<double>         touching(flow);
    const std::vector<double>          partner = partners(flow, touching);
    NodeContactsBar                    nodes(flow);
    std::vector<double>                partner_bar(T.size(), 0.);
    const auto                         at_nodes = nodal_surfaces(flow, touching, partner, T, skin);
    std::array<std::vector<double>, 2> at_nodes_bar;
    for (const unsigned int side : {0, 1})
      at_nodes_bar[side] =
        reverse_mean_over_faces(flow, touching, at_nodes[side], surfaces_bar[side], nodes, bar);
    for (NodeIndex k = 0; k < T.size(); ++k)
    {
      const double metal_bar = at_nodes_bar[0][k], die_bar = at_nodes_bar[1][k];
      if (!touching.has_film(flow, k))
        T_bar[k] += metal_bar;
      else if (metal_bar != 0. || die_bar != 0.)
      {
        constexpr int n = n_skin_arguments + 2;
        using Partial   = Sacado::Fad::SFad<double, n>;
        SurfaceArguments<Partial> x;
        SurfaceArguments<double>  x_bar = surface_arguments(flow, k, touching, partner, T, skin);
        int                       i     = 0;
        for_each_number([&](const double value, Partial &to) { to = Partial(n, i++, value); }, x_bar, x);
        const auto both = at_surface(x);
        i               = 0;
        for_each_number(
          [&](double &to) {
            to = metal_bar * both[0].dx(i) + die_bar * both[1].dx(i);
            ++i;
          },
          x_bar);
        T_bar[k] += x_bar.T;
        partner_bar[k] = x_bar.partner;
        skin_bar[k] += x_bar.skin.drops;
        nodes.reverse_arguments(flow, k, touching, x_bar.skin, bar);
      }
    }
    for (std::size_t i = 0; i < flow.surface.touching.size(); ++i)
      if (const auto &at = flow.surface.touching[i]; at.weight > 0.)
      {
        const double of_node = partner_bar[at.node] / touching.weight[at.node],
                     t       = flow.dies[at.die].temperature;
        bar.dies[at.die].temperature += of_node * at.weight;
        bar.surface.weight[i] += of_node * (t - partner[at.node]);
      }
    nodes.reverse_touching(flow, bar);
  }
} // namespace retroforge
