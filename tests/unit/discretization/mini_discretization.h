// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/discretization/element_pairs.h>

namespace retroforge
{
  /// The mini element's on a mesh, on each rank by itself. Fields of one such go with another.
  inline Discretization<3> mini_discretization(const TetMesh &mesh)
  {
    return {mesh, {ElementPair::mini}, MPI_COMM_SELF};
  }
} // namespace retroforge
