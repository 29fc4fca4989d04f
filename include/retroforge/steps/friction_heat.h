// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/equilibrium.h>

/// @file
/// Heat of friction, of which the part f goes into the metal: the power of each point of contact is shared out among
/// its nodes, each of which has the capacity of its part of the volume,
///   dT_k = dt f/(rho c V_k) sum_p w_pk P_p,  V_k = sum_c |c|/4,  w_pk 1 for a node's own point, 1/2 for an edge's.
/// In skins (heat/friction_in_skins.h) all of it is a flux, that on the part of the surface that touches dies as friction sees
/// it,
///   q_k = sum_d P_kd / (sum_d S^f_kd + 0.1 (S_k - sum_d S^f_kd)),
/// S_k the same if all faces at the node did: so that it sets in gradually where a first face touches.
namespace retroforge
{
  /// Adds it to the temperatures of all nodes, for the part view.weight of the time dt [s], on every rank.
  /// Collective.
  template <typename Number>
  void add_friction_heat(const EquilibriumView<Number> &view, const Number &dt, std::vector<Number> &T);

  /// Reverse of add_friction_heat: adds to the derivatives in the stage's unknowns and positions, in the laws and the
  /// dies, in the numbers of heat, and in dt, this rank's part.
  /// @param T_bar  of all nodes; the derivative after is that before
  void reverse_add_friction_heat(const EquilibriumView<double> &view,
                                 double                         dt,
                                 const std::vector<double>     &T_bar,
                                 EquilibriumBar                &bar);

  /// Adds the part view.weight of the flux [mW/mm^2] to those of all nodes, on every rank. Collective.
  template <typename Number>
  void add_friction_flux(const EquilibriumView<Number> &view, std::vector<Number> &flux);

  /// Reverse of add_friction_flux: adds this rank's part.
  /// @param flux_bar  of all nodes; the derivative after is that before
  void reverse_add_friction_flux(const EquilibriumView<double> &view,
                                 const std::vector<double>     &flux_bar,
                                 EquilibriumBar                &bar);
} // namespace retroforge
