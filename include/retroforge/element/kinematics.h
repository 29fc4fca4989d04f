// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

namespace retroforge
{
  /// The flow of the metal in space that a velocity with dim components stands for.
  enum class Kinematics
  {
    three_dimensions, ///< all of it
    plane_strain,     ///< (v_x, v_y, 0) of x and y; integrals are per mm of thickness
    /// (v_r, v_z) of the distance r = x from an axis and the height z = y along it, without swirl: the
    /// strain rate around the axis is v_r/r, and integrals are over whole rings, 2 pi r dr dz.
    axisymmetric
  };
} // namespace retroforge
