// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/rank_sum.h>
#include <retroforge/solver/equilibrium.h>

namespace retroforge
{
  /// The velocities with which the nodes of the mesh move: their own where velocities are linear; where they
  /// are quadratic, those that carry the volume along (discretization/vertex_motion.h). A node is as free as
  /// it does not touch a die: c_k = product over the dies of 1 - w(delta). The same on every rank.
  /// Collective.
  template <typename Number>
  NodalVectors<Number> motion(const Equilibrium<Number> &stage, const Field<Number> &W);

  /// Pull-back: adds to the derivatives in the velocities, the stage's positions, and the ramps of contact.
  /// @param motion_bar  the same on every rank
  void reverse_motion(const Equilibrium<double>     &stage,
                      const Field<double>           &W,
                      const NodalVectors<double>    &motion_bar,
                      Field<double>                 &W_bar,
                      RankSum<NodalVectors<double>> &X_bar,
                      RankSum<ContactSetBar>        &contact_bar);
} // namespace retroforge
