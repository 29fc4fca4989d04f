// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/tet_mesh.h>

namespace retroforge
{
  /// Takes away the cells with a dihedral angle below `limit` [degrees] that have two faces on one patch of
  /// the surface. A mesh generator that keeps the triangles of a curved surface makes such cells where four
  /// nodes lie almost in a plane, and has no cure for them. The edge that the two faces share gives way to
  /// the other diagonal of the same four nodes: all nodes stay, and stay on the patch, and other cells are as
  /// they were. A cell whose other diagonal is an edge of the boundary already stays, and so does one in a
  /// plane of symmetry.
  /// @return how many went
  unsigned int take_away_surface_slivers(TetMesh &mesh, double limit);
} // namespace retroforge
