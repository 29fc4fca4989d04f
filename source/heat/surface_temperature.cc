// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/heat/node_skins.h>
#include <retroforge/heat/surface_temperature.h>

namespace retroforge
{
  namespace
  {
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
    std::vector<Number> mean_over_faces(const HeatFlow<Number>                 &flow,
                                        const std::vector<NodeContact<Number>> &contacts,
                                        std::vector<Number>                     x)
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
      for (const auto &contact : contacts)
        if (contact.has_film)
          x[contact.node] = sum[contact.node] / contact.area;
      return x;
    }

    /// Reverse of mean_over_faces(): returns the derivatives in x.
    /// @param contacts_bar  one for each of `contacts`
    std::vector<double> reverse_mean_over_faces(const HeatFlow<double>                 &flow,
                                                const std::vector<NodeContact<double>> &contacts,
                                                const std::vector<double>              &x,
                                                const std::vector<double>              &mean_bar,
                                                std::vector<NodeContactBar>            &contacts_bar,
                                                HeatFlowBar                            &bar)
    {
      const std::vector<double> means = mean_over_faces(flow, contacts, x);
      std::vector<double>       x_bar = mean_bar, sum_bar(x.size(), 0.);
      for (std::size_t c = 0; c < contacts.size(); ++c)
        if (contacts[c].has_film)
        {
          const NodeIndex k = contacts[c].node;
          sum_bar[k]        = mean_bar[k] / contacts[c].area;
          x_bar[k]          = 0.;
          contacts_bar[c].area -= sum_bar[k] * means[k];
        }
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

    /// At the nodes themselves: the metal above the skin, as far as the node does not show that, and the dies.
    template <typename Number>
    std::array<std::vector<Number>, 2> nodal_surfaces(const HeatFlow<Number>                 &flow,
                                                      const std::vector<NodeContact<Number>> &contacts,
                                                      const std::vector<Number>              &T,
                                                      const NodeSkins<Number>                &skin)
    {
      std::vector<Number> metal = T, die(T.size(), Number(0.));
      for (const auto &contact : contacts)
        if (contact.has_film)
        {
          const NodeIndex    k     = contact.node;
          const Skin<Number> shown = parts_shown(flow.law, contact.depth(flow));
          metal[k] += shown * skin.metal[k] - drop_of(skin.metal[k]);
          die[k] = contact.die_temperature(flow) + drop_of(contact.dies_skin(flow, skin));
        }
      return {{std::move(metal), std::move(die)}};
    }
  } // namespace

  template <typename Number>
  std::array<std::vector<Number>, 2> surface_temperatures(const HeatFlow<Number>    &flow,
                                                          const std::vector<Number> &T,
                                                          const NodeSkins<Number>   &skin)
  {
    AssertDimension(T.size(), flow.network.volumes.size());
    AssertDimension(skin.metal.size(), T.size());
    const auto contacts = node_contacts(flow);
    auto [metal, die]   = nodal_surfaces(flow, contacts, T, skin);
    return {
      {mean_over_faces(flow, contacts, std::move(metal)), mean_over_faces(flow, contacts, std::move(die))}};
  }

  template std::array<std::vector<double>, 2>
  surface_temperatures(const HeatFlow<double> &, const std::vector<double> &, const NodeSkins<double> &);
  template std::array<std::vector<Dual>, 2>
  surface_temperatures(const HeatFlow<Dual> &, const std::vector<Dual> &, const NodeSkins<Dual> &);

  void reverse_surface_temperatures(const HeatFlow<double>                   &flow,
                                    const std::vector<double>                &T,
                                    const NodeSkins<double>                  &skin,
                                    const std::array<std::vector<double>, 2> &surfaces_bar,
                                    std::vector<double>                      &T_bar,
                                    NodeSkins<double>                        &skin_bar,
                                    HeatFlowBar                              &bar)
  {
    const auto                         contacts = node_contacts(flow);
    const auto                         at_nodes = nodal_surfaces(flow, contacts, T, skin);
    std::vector<NodeContactBar>        contacts_bar(contacts.begin(), contacts.end());
    std::array<std::vector<double>, 2> at_nodes_bar;
    for (const unsigned int side : {0, 1})
      at_nodes_bar[side] =
        reverse_mean_over_faces(flow, contacts, at_nodes[side], surfaces_bar[side], contacts_bar, bar);
    for (NodeIndex k = 0; k < T.size(); ++k)
      T_bar[k] += at_nodes_bar[0][k];
    for (std::size_t c = 0; c < contacts.size(); ++c)
    {
      const auto &contact = contacts[c];
      if (!contact.has_film)
        continue;
      const NodeIndex    k         = contact.node;
      const double       metal_bar = at_nodes_bar[0][k], die_bar = at_nodes_bar[1][k];
      const double       depth = contact.depth(flow);
      const Skin<double> shown = parts_shown(flow.law, depth);
      contacts_bar[c].depth += reverse_parts_shown(flow.law, depth, metal_bar * skin.metal[k], bar.law);
      contacts_bar[c].die_temperature += die_bar;
      for (unsigned int j = 0; j < n_skin_modes; ++j)
        skin_bar.metal[k][j] += metal_bar * (shown[j] - 1.);
      for (std::size_t e = 0; e < contact.entries.size(); ++e)
      {
        const unsigned int i = contact.entries[e], die = flow.surface.touching[i].die;
        contacts_bar[c].share[e] += die_bar * drop_of(skin.dies[die][k]);
        for (unsigned int j = 0; j < n_skin_modes; ++j)
          skin_bar.dies[die][k][j] += die_bar * contact.share(flow, i);
      }
    }
    for (std::size_t c = 0; c < contacts.size(); ++c)
      contacts_bar[c].reverse(flow, contacts[c], bar);
  }
} // namespace retroforge
