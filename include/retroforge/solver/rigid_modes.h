// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/equilibrium.h>

#include <optional>
#include <string>
#include <vector>

namespace retroforge
{
  /// The rigid motions (of six) that neither symmetry planes, nor the dies' normals, nor friction resist, in
  /// words: `slide along x', `turn about z at (0, 0, 20)'. Where there are some, velocities are not unique
  /// and the adjoint has no solution.
  /// @param within  of a die, nodes are held by it [mm]; left out, every die is brought to its nearest nodes
  std::vector<std::string> free_rigid_motions(const Scene                &scene,
                                              const Physics<double>      &physics,
                                              const NodalVectors<double> &X,
                                              std::optional<double>       within = {});

  /// Returns what holds a workpiece that touches dies on both sides, or a die and a plane of symmetry, in the
  /// rigid motions that its contacts, their friction where it acts on faces, and symmetry planes do not resist
  /// both ways: those that are felt there at less than a third of the root mean square speed. Points that a die
  /// touches along a line, wherever it runs, do not resist a turn about it. Nothing else is held.
  /// @param view   the workpiece and the dies at the start of an increment
  /// @param pairs  those within `near` of a die, and others
  /// @param near   of a die, points touch it [mm]
  RigidHold hold_of_loose(const Scene               &scene,
                          const Physics<double>     &physics,
                          const ContactView<double> &view,
                          std::vector<ContactPair>   pairs,
                          double                     near);

  /// The motions in words, as those of free_rigid_motions().
  std::vector<std::string> held_motions(const RigidHold &hold, const NodalVectors<double> &X);
} // namespace retroforge
