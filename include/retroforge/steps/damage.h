// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/metal_stress.h>

/// @file
/// The damage that a stage adds to each cell (material/damage_law.h):
///   D' = D + dt b_s max(sigma_1, 0)/sigma_0 e,
/// of the mean stress and strain rate of the cell, and the flow stress there.
namespace retroforge
{
  /// Adds it, for the part view.weight of the time dt [s], on every rank. Collective.
  template <typename Number>
  void add_damage(const EquilibriumView<Number> &view, const Number &dt, std::vector<Number> &damage);

  /// Reverse of add_damage(): adds to the derivatives in the stage's unknowns and positions, in the laws and
  /// states of the metal, and in dt, this rank's part.
  /// @param damage_bar  of all cells; the derivative after is that before
  void reverse_add_damage(const EquilibriumView<double> &view,
                          double                         dt,
                          const std::vector<double>     &damage_bar,
                          EquilibriumBar                &bar);
} // namespace retroforge
