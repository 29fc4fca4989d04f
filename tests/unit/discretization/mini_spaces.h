// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/discretization/element_pairs.h>

namespace retroforge
{
  /// The mini element's on a mesh alone.
  inline Spaces mini_spaces(const TetMesh &mesh)
  {
    return Spaces(mesh, Topology(mesh), ElementPair::mini);
  }
} // namespace retroforge
