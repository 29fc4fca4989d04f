// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/stage.h>

namespace retroforge
{
  /// Number of rigid motions (of six) that neither symmetry planes, nor the dies' normals, nor friction
  /// resist, judged with every die brought to its nearest nodes. Where it is not zero, velocities are not
  /// unique and the adjoint has no solution.
  unsigned int
  n_free_rigid_modes(const Scene &scene, const Physics<double> &physics, const NodalVectors<double> &X);
} // namespace retroforge
