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
} // namespace retroforge
