// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/tet_mesh.h>

#include <string>

namespace retroforge
{
  /// Throws Error, its place given by `where` (file or parameter path), unless the mesh is one the
  /// solver can use:
  /// positions are finite; every index exists; there are cells, all with positive volume (more
  /// precisely  6V > 1e-10 l^3,  l the longest edge); every node belongs to a cell; at most two cells share a
  /// face; the boundary faces are exactly the faces of one cell only, each listed once and turned outwards;
  /// and the boundary is a manifold: two boundary faces at each of its edges, one fan of faces at
  /// each of its nodes.
  void check_mesh(const TetMesh &mesh, const std::string &where);
} // namespace retroforge
