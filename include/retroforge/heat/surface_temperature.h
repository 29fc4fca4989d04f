// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/heat/heat_flow.h>

#include <vector>

/// @file
/// Temperatures on either side of the film between metal and dies. Volume over area, and with it how fast a node is
/// chilled, varies from one node of an unstructured mesh to the next: each touching face has the mean of its nodes, and each
/// node the mean of its faces, by what of them touches.
namespace retroforge
{
  /// Returns for each entry of `touching` the temperature of its die's surface, 0 where no area touches [C].
  template <typename Number>
  std::vector<Number> dies_surfaces(const ThermalSurface<Number>        &surface,
                                    const std::vector<DieState<Number>> &dies,
                                    const NodeSkins<Number>             &skin);

  /// Reverse of dies_surfaces(): adds to surface_bar, to the temperatures in dies_bar, and to skin_bar.
  void reverse_dies_surfaces(const ThermalSurface<double>        &surface,
                             const std::vector<DieState<double>> &dies,
                             const NodeSkins<double>             &skin,
                             const std::vector<double>           &temperatures_bar,
                             ThermalSurfaceBar                   &surface_bar,
                             std::vector<DieState<double>>       &dies_bar,
                             NodeSkins<double>                   &skin_bar);

  /// Returns at each node the mean of what its entries of `touching` have, by area; where none touches, what there was.
  std::vector<double> means_at_nodes(const ThermalSurface<double> &surface,
                                     const std::vector<double>    &of_entries,
                                     std::vector<double>           elsewhere);

  /// Returns the temperatures of the metal, at its surface those above the skin, also where a contact has opened; each at
  /// every node [C].
  std::vector<double>
  metals_surface(const HeatFlow<double> &flow, const std::vector<double> &T, const NodeSkins<double> &skin);
} // namespace retroforge
