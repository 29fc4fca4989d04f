// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/heat/heat_flow.h>

#include <array>
#include <vector>

/// @file
/// Temperatures on either side of the film between metal and dies. Volume over area, and with it how fast a node is
/// chilled, varies from one node of an unstructured mesh to the next: each touching face has the mean of its nodes, and each
/// node the mean of its faces, by what of them touches.
namespace retroforge
{
  /// Returns the temperatures of the metal, at its surface those above the skin, and of the dies' surfaces, 0 where
  /// none touches; each at every node [C].
  template <typename Number>
  std::array<std::vector<Number>, 2> surface_temperatures(const HeatFlow<Number>    &flow,
                                                          const std::vector<Number> &T,
                                                          const NodeSkins<Number>   &skin);

  /// Reverse of surface_temperatures(): adds to T_bar, skin_bar, and bar.
  /// @param surfaces_bar  derivatives in both
  void reverse_surface_temperatures(const HeatFlow<double>                   &flow,
                                    const std::vector<double>                &T,
                                    const NodeSkins<double>                  &skin,
                                    const std::array<std::vector<double>, 2> &surfaces_bar,
                                    std::vector<double>                      &T_bar,
                                    NodeSkins<double>                        &skin_bar,
                                    HeatFlowBar                              &bar);
} // namespace retroforge
