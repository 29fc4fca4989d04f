// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/heat/thermal_surface.h>
#include <retroforge/material/heat_law.h>

/// @file
/// Skins (skin.h) of a workpiece that waits. Where no die touches, the heat that a contact has taken out of a thin layer
/// spreads in the metal, and the next contact finds a surface almost as warm as what is beneath it.
namespace retroforge
{
  /// Takes the skins of all nodes [mJ/(mm^2 K)] over a time, those that touch a die as far as they do not; the skins are
  /// those of contacts under the press.
  /// @param time  [s], > 0
  template <typename Number>
  void heal_skins(const ThermalSurface<Number> &surface,
                  const HeatLaw<Number>        &law,
                  const Number                 &time,
                  std::vector<Number>          &skin);

  /// Derivatives of a scalar in what skins heal by.
  struct HealingBar
  {
    ThermalSurfaceBar &surface;
    HeatLaw<double>   &law;
    double            &time;
  };

  /// Reverse of heal_skins().
  /// @param skin      before
  /// @param skin_bar  derivatives in those after on entry, in those before on exit
  void reverse_heal_skins(const ThermalSurface<double> &surface,
                          const HeatLaw<double>        &law,
                          double                        time,
                          const std::vector<double>    &skin,
                          std::vector<double>          &skin_bar,
                          const HealingBar             &bar);
} // namespace retroforge
