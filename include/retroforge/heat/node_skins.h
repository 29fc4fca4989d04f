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
  /// What the skin beneath a node's contacts depends on.
  template <typename Number>
  struct SkinArguments
  {
    Number e, h, k, capacity, die_effusivity, depth, dt;

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[e, h, k, capacity, die_effusivity, depth, dt] = self;
      return std::tie(e, h, k, capacity, die_effusivity, depth, dt);
    }
  };

  /// Effusivity of metal and die together, and the metal's part of the drop in the skins.
  template <typename Number>
  std::pair<Number, Number> joint_skins(const SkinArguments<Number> &of)
  {
    using std::sqrt;
    const Number metal = sqrt(Number(of.k * of.capacity)), both = joint_effusivity(metal, of.die_effusivity);
    return {both, both / metal};
  }

  /// R for skins with the Biot number y.
  template <typename Number>
  Number skin_resistance(const SkinArguments<Number> &of, const Number &metals_part, const Number &y)
  {
    const Number thickness = 3. * of.k * y * metals_part / of.h;
    const Number rest      = 1. - thickness / (8. * of.depth);
    const Number resolved  = value_of(rest) > 0. ? Number(rest * rest) : Number(0.);
    return y * (metals_part * resolved + (1. - metals_part));
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

  /// The skin is there for the part of the time in which the node touches.
  template <typename Number>
  SkinArguments<Number> skin_arguments(const HeatFlow<Number>     &flow,
                                       const NodeIndex             k,
                                       const NodeContacts<Number> &touching,
                                       const Number               &e,
                                       const Number               &dt)
  {
    const HeatLaw<Number> &law = flow.law;
    return {e,
            flow.contact_film,
            law.conductivity,
            law.capacity,
            law.die_effusivity,
            flow.network.volumes[k] / touching.area[k],
            touching.weight[k] * dt};
  }

  /// Derivatives in what of each node touches dies.
  struct NodeContactsBar
  {
    std::vector<double> weight, area;

    explicit NodeContactsBar(const HeatFlow<double> &flow)
        : weight(flow.network.volumes.size(), 0.), area(weight)
    {
    }

    /// Reverse of skin_arguments(), but for e.
    void reverse_arguments(const HeatFlow<double>      &flow,
                           const NodeIndex              k,
                           const NodeContacts<double>  &touching,
                           const double                 dt,
                           const SkinArguments<double> &x_bar,
                           HeatFlowBar                 &bar)
    {
      const double of_node = touching.area[k];
      bar.contact_film += x_bar.h;
      bar.dt += x_bar.dt * touching.weight[k];
      bar.law.conductivity += x_bar.k;
      bar.law.capacity += x_bar.capacity;
      bar.law.die_effusivity += x_bar.die_effusivity;
      bar.network.volumes[k] += x_bar.depth / of_node;
      weight[k] += x_bar.dt * dt;
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
