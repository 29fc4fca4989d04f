// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/heat/conduction_network.h>
#include <retroforge/heat/skin.h>
#include <retroforge/heat/thermal_surface.h>
#include <retroforge/material/heat_law.h>

#include <array>

/// @file
/// Heat that flows for a time in a workpiece at rest, to dies that it touches and to its surroundings.
///
/// The film between a node and a die has the conductance  A h_c/(1 + R),  A the area there that touches, and R the
/// drops of temperature in the skins of metal and die that grow meanwhile over that across the film; behind it is the
/// temperature that the skins of before leave (contact_skins.h).
/// A free surface has  h_a + eps sigma (T² + T_a²)(T + T_a),  temperatures absolute.
namespace retroforge
{
  /// What heat flows in.
  template <typename Number>
  struct HeatFlow
  {
    const NetworkEdges                  &edges;
    const ConductionNetwork<Number>     &network;
    const ThermalSurface<Number>        &surface;
    const HeatLaw<Number>               &law;
    const Number                        &contact_film; ///< h_c [mW/(mm^2 K)]
    const std::vector<DieState<Number>> &dies;
    /// Heat that friction makes between nodes and dies, per area and time [mW/mm^2]; null: none.
    const std::vector<Number> *friction = nullptr;
  };

  /// Takes temperatures [C] and skins of all nodes over a time.
  /// @return heat that came in through the surface [mJ]
  template <typename Number>
  Number
  conduct(const HeatFlow<Number> &flow, const Number &dt, std::vector<Number> &T, NodeSkins<Number> &skin);

  /// Derivatives of a scalar in what heat flows in.
  struct HeatFlowBar
  {
    ConductionNetwork<double>     &network;
    ThermalSurfaceBar             &surface;
    HeatLaw<double>               &law;
    double                        &contact_film;
    std::vector<DieState<double>> &dies;
    double                        &dt;
    std::vector<double>           *friction = nullptr; ///< where the flow has one
  };

  /// Reverse of conduct().
  /// @param T, skin          before
  /// @param T_bar, skin_bar  derivatives in those after on entry, in those before on exit
  void reverse_conduct(const HeatFlow<double>    &flow,
                       double                     dt,
                       const std::vector<double> &T,
                       const NodeSkins<double>   &skin,
                       std::vector<double>       &T_bar,
                       NodeSkins<double>         &skin_bar,
                       HeatFlowBar               &bar);

  /// Returns what touches under the press, where workpiece and dies are; dies that are not in the press touch nothing.
  template <typename Number>
  ThermalSurface<Number> surface_under_press(const ContactView<Number> &view, double gap);
} // namespace retroforge
