// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/equilibrium.h>

namespace retroforge
{
  /// Returns g_j of each motion of the stage's hold for a field like a velocity. Collective.
  template <typename Number>
  std::vector<Number> mean_speeds(const Equilibrium<Number> &stage, const NodeVector<3, Number> &V);

  /// Adds the hold's forces on owned nodes to the residual. Collective.
  template <typename Number>
  void add_hold_forces(const Equilibrium<Number> &stage, const Field<Number> &W, Field<Number> &r);

  /// Adds the derivatives of  lambda·force  in the positions, this rank's part. Collective.
  void reverse_hold_forces(const EquilibriumView<double> &view,
                           const Field<double>           &lambda,
                           NodalVectors<double>          &X_bar);

  /// Returns what the hold bears. Collective.
  HoldLoad hold_load(const EquilibriumView<double> &view);
} // namespace retroforge
