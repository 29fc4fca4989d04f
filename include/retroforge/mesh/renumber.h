// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/tet_mesh.h>

namespace retroforge
{
  /// Numbers the nodes by reverse Cuthill-McKee, so that nodes of one cell have near numbers and a
  /// contiguous range of nodes is a compact piece of the workpiece (`of_file` follows); then sorts cells and
  /// boundary faces by their smallest node, and turns each (keeping its orientation) to begin with it.
  /// Deterministic; a mesh that differs only in the order of cells or faces gives the same numbers.
  /// @return the new number of each node
  std::vector<NodeIndex> renumber(TetMesh &mesh);
} // namespace retroforge
