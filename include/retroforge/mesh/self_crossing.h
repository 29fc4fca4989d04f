// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/tet_mesh.h>

#include <string>
#include <vector>

namespace retroforge
{
  /// An edge of the boundary that passes through a face of it that it shares no node with.
  struct SelfCrossing
  {
    std::array<NodeIndex, 2> edge;
    unsigned int             face; ///< index into TetMesh::faces
  };

  /// All there are at positions X, by edge (the smaller node first; found at the face whose edge runs so),
  /// then face. Faces of symmetry planes count.
  std::vector<SelfCrossing> self_crossings(const TetMesh &mesh, const NodalVectors<double> &X);

  /// Throws Error at `where`, with the place, when there is one.
  void
  check_boundary_does_not_cross(const TetMesh &mesh, const NodalVectors<double> &X, const std::string &where);
} // namespace retroforge
