// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/stage.h>

/// @file
/// What Newton's method does about contact besides its steps, for a stage whose active set is not recorded.
///
/// The penalty of nodes is stiff. A search for the minimum of the functional along a step therefore ends
/// where the first node meets its die, and the nodes would arrive one Newton step after the other. A
/// primal-dual active set method takes the step with the contacts it was solved for, and lets all that
/// arrive, arrive at once: their velocities are corrected by what they would go through the die. The
/// functional's own search remains the way out when that does not settle.
namespace retroforge
{
  /// Makes a velocity field from elsewhere (an earlier increment, another mesh) respect the dies: the normal
  /// velocity of nodes that would go through one, or that are pressed against it, becomes the die's.
  /// Then the residual is the metal's, and not that of a normal that turned, times a penalty.
  /// @param pressed  which pairs are; else those where the metal presses when no node is held
  /// @return of each pair, whether its node was put onto its die
  std::vector<char>
  hold_on_dies(const Stage<double> &stage, Field<double> &W, const ActiveChoice &pressed = {});

  /// Lets the nodes that were put onto dies sink in as far as the metal presses them: without that, the
  /// forces of the dies were missing from the residual, and a step of Newton's method would find them.
  void lean_on_dies(const Stage<double> &stage, const std::vector<char> &held, Field<double> &W);

  /// The same for the nodes that were not active and would go through a die after a step.
  /// @param active  of the step
  void stop_at_dies(const Stage<double> &stage, const ActiveSet &active, Field<double> &W);
} // namespace retroforge
