// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/heat/heat_flow.h>
#include <retroforge/heat/skin.h>

#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

/// @file
/// The skins of nodes that touch dies, as what flows through them and temperatures above them need them.
namespace retroforge
{
  /// What lies between a node and the dies that it touches.
  template <typename Number>
  struct SkinArguments
  {
    Number       k, capacity, die_effusivity, depth;
    Skin<Number> drops; ///< now, or on the mean over a step

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[k, capacity, die_effusivity, depth, drops] = self;
      return std::tie(k, capacity, die_effusivity, depth, drops);
    }
  };

  constexpr int n_skin_arguments = 4 + n_skin_modes;

  /// Effusivity of the metal.
  template <typename Number>
  Number metals_effusivity(const Number &k, const Number &capacity)
  {
    using std::sqrt;
    return sqrt(Number(k * capacity));
  }

  /// The part of a mode of the metal's drop that a node shows which stands for a depth d, by x = lambda d²/a, a the
  /// diffusivity. The node of a chain of elements has, beneath a flux at the frequency s, the drop of the surface over
  /// sqrt(1 + s d²/a), all of slow modes and more of those of its own time, of which it knows later. This is near to that
  /// for the six, and of those of its form with the smallest errors of surfaces and heat, for elements of 0.5 to 8 mm.
  template <typename Number>
  Number shown_by_node(const Number &x)
  {
    using std::sqrt;
    const Number y = 1. + x * sqrt(Number(sqrt(x))); // 1 + x^(5/4)
    return (1. + 3.85 * x) / (y * y * sqrt(Number(sqrt(y))));
  }

  /// Drops of temperature between a node and its dies.
  template <typename Number>
  struct NodeDrops
  {
    Number all; ///< of the difference between node and die, over that across the film: 1 + R
    Number die; ///< of the die, over that across the film
  };

  /// A node that is warmer than the metal above it, as where a film has fallen, is so by at most half of the drop across the film.
  template <typename Number>
  NodeDrops<Number> drops_at(const SkinArguments<Number> &of)
  {
    using std::exp;
    const Number metal = metals_effusivity(of.k, of.capacity),
                 part  = joint_effusivity(metal, of.die_effusivity) / metal,
                 scale = of.depth * of.depth * of.capacity / of.k;
    Number shown(0.);
    for (unsigned int j = 0; j < n_skin_modes; ++j)
      shown += part * shown_by_node(Number(skin_rates[j] * scale)) * of.drops[j];
    const Number drop = drop_of(of.drops), across = 1. - drop;
    const Number all = (1. - shown) / across;
    return {value_of(all) >= 1. ? all : Number(0.5 + 0.5 * exp(Number(2. * (all - 1.)))),
            (1. - part) * drop / across};
  }

  /// What of each node touches dies: sums over them of w and of areas.
  template <typename Number>
  struct NodeContacts
  {
    std::vector<Number> weight, area;

    explicit NodeContacts(const HeatFlow<Number> &flow)
        : weight(flow.network.volumes.size(), Number(0.)), area(weight)
    {
      for (const auto &at : flow.surface.touching)
      {
        weight[at.node] += at.weight;
        area[at.node] += at.area;
      }
    }

    /// Whether a node has a film to a die.
    bool has_film(const HeatFlow<Number> &flow, const NodeIndex k) const
    {
      return value_of(weight[k]) > 0. && value_of(area[k]) > 0. && value_of(flow.contact_film) > 0.;
    }
  };

  template <typename Number>
  SkinArguments<Number> skin_arguments(const HeatFlow<Number>     &flow,
                                       const NodeIndex             k,
                                       const NodeContacts<Number> &touching,
                                       const Skin<Number>         &drops)
  {
    const HeatLaw<Number> &law = flow.law;
    return {
      law.conductivity, law.capacity, law.die_effusivity, flow.network.volumes[k] / touching.area[k], drops};
  }

  /// Derivatives in what of each node touches dies.
  struct NodeContactsBar
  {
    std::vector<double> weight, area;

    explicit NodeContactsBar(const HeatFlow<double> &flow)
        : weight(flow.network.volumes.size(), 0.), area(weight)
    {
    }

    /// Reverse of skin_arguments(), but for the drops.
    void reverse_arguments(const HeatFlow<double>      &flow,
                           const NodeIndex              k,
                           const NodeContacts<double>  &touching,
                           const SkinArguments<double> &x_bar,
                           HeatFlowBar                 &bar)
    {
      const double of_node = touching.area[k];
      bar.law.conductivity += x_bar.k;
      bar.law.capacity += x_bar.capacity;
      bar.law.die_effusivity += x_bar.die_effusivity;
      bar.network.volumes[k] += x_bar.depth / of_node;
      area[k] -= x_bar.depth * flow.network.volumes[k] / (of_node * of_node);
    }

    /// Reverse of NodeContacts' sums.
    void reverse_touching(const HeatFlow<double> &flow, HeatFlowBar &bar) const
    {
      for (std::size_t i = 0; i < flow.surface.touching.size(); ++i)
      {
        bar.surface.weight[i] += weight[flow.surface.touching[i].node];
        bar.surface.touching_area[i] += area[flow.surface.touching[i].node];
      }
    }
  };
} // namespace retroforge
