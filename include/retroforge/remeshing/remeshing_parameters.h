// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/parameter_handler.h>

#include <retroforge/remeshing/size_field.h>

namespace retroforge
{
  /// Moves a point of the surface out of a die it would be inside of; returns other points as they are.
  using PushOut = std::function<Vec3(const Vec3 &)>;

  /// Says whether a point of the surface touches a die, off which the volume correction must not move it.
  using TouchesDie = std::function<bool(const Vec3 &)>;

  /// When to remesh and how far to go. Angles in degrees, lengths relative to the wanted edge length h.
  struct RemeshingParameters
  {
    double trigger_angle = 15; ///< remesh when a dihedral angle is smaller
    double goal_angle    = 20; ///< move and insert nodes until no dihedral angle is smaller
    double swap_angle    = 30; ///< exchange edges and faces up to here: that costs no diffusion

    double ridge_angle  = 40; ///< faces of one patch that turn by more form a ridge
    double corner_angle = 45; ///< a ridge that turns by more has a corner there

    double shortest_edge = 0.6; ///< shorter edges are collapsed
    double longest_edge  = 1.6; ///< longer edges are split

    double surface_deviation = 0.1;  ///< how far a collapse may move the surface
    double ridge_deviation   = 0.05; ///< how far a collapse may move a ridge, or a flip the surface
    double kept_move         = 0.01; ///< nodes the volume correction moves by less keep their values

    unsigned int max_sweeps = 6;

    void add_parameters(dealii::ParameterHandler &prm);
    void check() const;
  };
} // namespace retroforge
