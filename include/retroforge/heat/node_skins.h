// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/heat/heat_flow.h>
#include <retroforge/heat/skin.h>

#include <array>
#include <cmath>
#include <vector>

/// @file
/// What of nodes touches dies, and what a node of a mesh shows of the skin beneath it.
namespace retroforge
{
  /// Effusivity of the metal.
  template <typename Number>
  Number metals_effusivity(const HeatLaw<Number> &law)
  {
    using std::sqrt;
    return sqrt(Number(law.conductivity * law.capacity));
  }

  /// Reverse of metals_effusivity().
  inline void
  reverse_metals_effusivity(const HeatLaw<double> &law, const double metal_bar, HeatLaw<double> &law_bar)
  {
    const double metal = metals_effusivity(law);
    law_bar.conductivity += metal_bar * 0.5 * metal / law.conductivity;
    law_bar.capacity += metal_bar * 0.5 * metal / law.capacity;
  }

  /// Of the drop in the skins of metal and die the metal's part, b/b_m.
  template <typename Number>
  Number metals_part(const HeatLaw<Number> &law)
  {
    return law.die_effusivity / (metals_effusivity(law) + law.die_effusivity);
  }

  /// Reverse of metals_part().
  inline void reverse_metals_part(const HeatLaw<double> &law, const double part_bar, HeatLaw<double> &law_bar)
  {
    const double metal = metals_effusivity(law), both = metal + law.die_effusivity;
    law_bar.die_effusivity += part_bar * metal / (both * both);
    reverse_metals_effusivity(law, -part_bar * law.die_effusivity / (both * both), law_bar);
  }

  /// From here on less than rounding is shown; depths of nodes that hardly touch would overflow.
  constexpr double all_hidden = 1e9;

  /// The part of a mode of the metal's drop that a node shows which stands for a depth d, by x = lambda d²/a, a the
  /// diffusivity. The node of a chain of elements has, beneath a flux at the frequency s, the drop of the surface over
  /// sqrt(1 + s d²/a), all of slow modes and more of those of its own time, of which it knows later. This is near to that
  /// for the six, and of those of its form with the smallest errors of surfaces and heat, for elements of 0.5 to 8 mm.
  template <typename Number>
  Number shown_by_node(const Number &x)
  {
    using std::pow;
    if (value_of(x) > all_hidden)
      return Number(0.);
    return (1. + 4.46 * x) / pow(Number(1. + 0.68 * pow(x, 0.925)), 3.19);
  }

  inline double slope_of_shown_by_node(const double x)
  {
    if (x > all_hidden)
      return 0.;
    const double grown = 0.68 * std::pow(x, 0.925), y = 1. + grown;
    return (4.46 - 3.19 * 0.925 * grown / (x * y) * (1. + 4.46 * x)) / std::pow(y, 3.19);
  }

  /// d²/a of a node that stands for the depth d.
  template <typename Number>
  Number time_of_depth(const HeatLaw<Number> &law, const Number &depth)
  {
    return depth * depth * law.capacity / law.conductivity;
  }

  /// The parts of all modes that a node shows.
  template <typename Number>
  Skin<Number> parts_shown(const HeatLaw<Number> &law, const Number &depth)
  {
    const Number time = time_of_depth(law, depth);
    Skin<Number> shown;
    for (unsigned int j = 0; j < n_skin_modes; ++j)
      shown[j] = shown_by_node(Number(skin_rates[j] * time));
    return shown;
  }

  /// Reverse of parts_shown(): adds to the law's derivatives, and returns that in the depth.
  inline double reverse_parts_shown(const HeatLaw<double> &law,
                                    const double           depth,
                                    const Skin<double>    &shown_bar,
                                    HeatLaw<double>       &law_bar)
  {
    const double time     = time_of_depth(law, depth);
    double       time_bar = 0.;
    for (unsigned int j = 0; j < n_skin_modes; ++j)
      time_bar += shown_bar[j] * skin_rates[j] * slope_of_shown_by_node(skin_rates[j] * time);
    law_bar.capacity += time_bar * time / law.capacity;
    law_bar.conductivity -= time_bar * time / law.conductivity;
    return 2. * time_bar * time / depth;
  }

  /// What of a node touches dies.
  template <typename Number>
  struct NodeContact
  {
    NodeIndex                 node;
    std::vector<unsigned int> entries; ///< of ThermalSurface::touching
    Number                    weight;  ///< as far as it touches any die, 1 - product(1 - w)
    Number                    area;    ///< of its surface that does [mm^2]
    bool                      has_film;

    /// The part of that area which touches the die of an entry.
    Number share(const HeatFlow<Number> &flow, const unsigned int entry) const
    {
      return flow.surface.touching[entry].area / area;
    }

    /// Volume over area: half the height of the cells there.
    Number depth(const HeatFlow<Number> &flow) const { return flow.network.volumes[node] / area; }

    /// Mean temperature of the dies [C].
    Number die_temperature(const HeatFlow<Number> &flow) const
    {
      Number mean(0.);
      for (const unsigned int i : entries)
        mean += share(flow, i) * flow.dies[flow.surface.touching[i].die].temperature;
      return mean;
    }

    /// Mean skin of the dies.
    Skin<Number> dies_skin(const HeatFlow<Number> &flow, const NodeSkins<Number> &skin) const
    {
      Skin<Number> mean;
      for (const unsigned int i : entries)
        mean += share(flow, i) * skin.dies[flow.surface.touching[i].die][node];
      return mean;
    }
  };

  /// Of all nodes that touch, ascending.
  template <typename Number>
  std::vector<NodeContact<Number>> node_contacts(const HeatFlow<Number> &flow)
  {
    std::vector<std::vector<unsigned int>> entries(flow.network.volumes.size());
    const auto                            &touching = flow.surface.touching;
    for (unsigned int i = 0; i < touching.size(); ++i)
      if (value_of(touching[i].weight) > 0.)
        entries[touching[i].node].push_back(i);
    std::vector<NodeContact<Number>> contacts;
    for (NodeIndex k = 0; k < entries.size(); ++k)
      if (!entries[k].empty())
      {
        NodeContact<Number> contact{k, std::move(entries[k]), Number(0.), Number(0.), false};
        for (const unsigned int i : contact.entries)
        {
          contact.weight += (1. - contact.weight) * touching[i].weight;
          contact.area += touching[i].area;
        }
        contact.has_film = value_of(contact.area) > 0. && value_of(flow.contact_film) > 0.;
        contacts.push_back(std::move(contact));
      }
    return contacts;
  }

  /// Derivatives in what of a node touches dies, and their way to where it comes from.
  struct NodeContactBar
  {
    double weight = 0., area = 0., depth = 0., die_temperature = 0.;
    /// Of each entry: in its share, and in its weight by itself.
    std::vector<double> share, entry_weight;

    explicit NodeContactBar(const NodeContact<double> &contact)
        : share(contact.entries.size(), 0.), entry_weight(contact.entries.size(), 0.)
    {
    }

    void reverse(const HeatFlow<double> &flow, const NodeContact<double> &contact, HeatFlowBar &bar)
    {
      const auto &touching = flow.surface.touching;
      if (contact.has_film)
      {
        const double volume = flow.network.volumes[contact.node];
        bar.network.volumes[contact.node] += depth / contact.area;
        area -= depth * volume / (contact.area * contact.area);
        for (std::size_t e = 0; e < contact.entries.size(); ++e)
        {
          const unsigned int i = contact.entries[e], die = touching[i].die;
          const double       of_area = contact.share(flow, i);
          bar.dies[die].temperature += die_temperature * of_area;
          share[e] += die_temperature * flow.dies[die].temperature;
          bar.surface.touching_area[i] += share[e] / contact.area;
          area -= share[e] * of_area / contact.area;
        }
      }
      for (std::size_t e = 0; e < contact.entries.size(); ++e)
      {
        double others = 1.;
        for (const unsigned int j : contact.entries)
          if (j != contact.entries[e])
            others *= 1. - touching[j].weight;
        bar.surface.weight[contact.entries[e]] += entry_weight[e] + weight * others;
        bar.surface.touching_area[contact.entries[e]] += area;
      }
    }
  };
} // namespace retroforge
