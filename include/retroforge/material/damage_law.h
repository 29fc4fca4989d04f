// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/dual.h>

/// @file
/// Ductile damage of the metal: a number that grows with the strain where the metal is pulled, by which parts are
/// compared. It does not weaken the metal.
namespace retroforge
{
  enum class Damage : unsigned int
  {
    none,
    latham_cockcroft ///< normalised: dD/dt = max(sigma_1, 0)/sigma_0 e
  };

  /// Part of the flow stress over which tension sets in.
  inline constexpr double tension_width = 0.02;

  /// max(y, 0), twice differentiable: 0 below -w/2, y above w/2, and between, with t = y/w + 1/2, w (t^3 - t^4/2);
  /// at y = 0 it is 0.094 w, w = tension_width.
  template <typename Number>
  Number smooth_tension(const Number &y)
  {
    const Number t = y / tension_width + 0.5;
    if (value_of(t) <= 0.)
      return Number(0.);
    if (value_of(t) >= 1.)
      return y;
    return tension_width * t * t * t * (1. - 0.5 * t);
  }

  /// Rate of the normalised damage of Latham and Cockcroft [1/s], whose integral has no unit.
  /// @param sigma_1  largest principal stress, positive in tension [MPa]
  /// @param sigma_0  flow stress [MPa]   @param e  equivalent strain rate [1/s]   @cite Cockcroft1968
  template <typename Number>
  Number latham_cockcroft_rate(const Number &sigma_1, const Number &sigma_0, const Number &e)
  {
    return smooth_tension(Number(sigma_1 / sigma_0)) * e;
  }
} // namespace retroforge
