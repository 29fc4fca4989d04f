// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/equilibrium.h>

namespace retroforge
{
  /// Die, pressure and slip at each node of the surface; zero at nodes that no die presses.
  struct ContactFields
  {
    /// The die that presses, counted from 1 in the order of Dies/names; of several the strongest.
    std::vector<double> die;
    /// p_k = F_k / A_k [MPa]: the pushing forces at the node, and its half of those at the middles of its
    /// edges, over a third of the areas of the surface faces at it. sum_k p_k A_k is all the force that the
    /// dies push with.
    std::vector<double> pressure;
    /// dv = u - (u·n) n,  u = V - v_die, against that die [mm/s].
    NodalVectors<double> slip;
  };

  /// @param W, active  the stage's solution, on every rank, and who presses in it
  ContactFields
  contact_fields(const Equilibrium<double> &stage, const Field<double> &W, const ActiveSet &active);
} // namespace retroforge
