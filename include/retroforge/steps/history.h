// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/equilibrium.h>
#include <retroforge/steps/workpiece_state.h>

/// @file
/// The step that adds to the history of the metal what the solved stages of an increment of time dt give it:
/// the strain  q' = q + dt sum_s b_s e(Y_s, W_s)  of each cell (discretization/strain_history.h).
namespace retroforge
{
  /// Adds one stage, weighted as its view says, in the cells this rank owns; on dual numbers the tangent.
  template <typename Number>
  void add_history(const EquilibriumView<Number> &view, const Number &dt, WorkpieceState<3, Number> &state);

  /// Gives every rank the cells of the others, after the last stage. Collective.
  template <typename Number>
  void complete_history(const Discretization<3> &discretization, WorkpieceState<3, Number> &state);

  /// Reverse of add_history(): adds to the derivatives in the stage's unknowns and positions, and in dt, this
  /// rank's part. The costate of the state after is that of the state before.
  void reverse_history(const EquilibriumView<double>   &view,
                       double                           dt,
                       const WorkpieceState<3, double> &costate,
                       EquilibriumBar                  &bar);
} // namespace retroforge
