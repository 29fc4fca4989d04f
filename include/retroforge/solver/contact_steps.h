// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/equilibrium.h>

/// @file
/// Corrections of velocities at the dies between the steps of Newton's method, for a stage whose active set
/// is not recorded.
///
/// The penalty of nodes is stiff. A search for the minimum of the functional along a step therefore ends
/// where the first node meets its die, and the nodes would arrive one Newton step after the other. A
/// primal-dual active set method takes the step with the contacts it was solved for, and lets all nodes
/// arrive at once: their velocities are corrected by the excess with which they would penetrate the die.
/// Where that does not converge, the search along the step remains.
namespace retroforge
{
  /// Projects a velocity field from elsewhere (an earlier increment, another mesh) onto the dies: the normal
  /// velocity of nodes that would penetrate a die, or that are pressed against it, becomes the die's.
  /// Then the residual is the metal's, and not that of a normal that turned, times a penalty.
  /// @param pressed  for each contact pair, whether its node is pressed against the die; where it is not
  ///                 given, decided by the force with which the metal presses when no node is held
  /// @return for each contact pair, whether its node was projected
  std::vector<char>
  project_onto_dies(const Equilibrium<double> &stage, Field<double> &W, const ActiveChoice &pressed = {});

  /// Gives each projected node the approach excess at which its penalty balances the force of the metal.
  /// Without that, contact forces were missing from the residual, and a step of Newton's method would find
  /// them.
  /// @param held  the result of project_onto_dies()
  void
  apply_contact_pressure(const Equilibrium<double> &stage, const std::vector<char> &held, Field<double> &W);

  /// Projects the nodes that were not active in a step, and that would penetrate a die after it.
  /// @param active  active set of the step
  void clip_to_dies(const Equilibrium<double> &stage, const ActiveSet &active, Field<double> &W);
} // namespace retroforge
