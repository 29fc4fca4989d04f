// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/tet_mesh.h>

#include <functional>
#include <string>
#include <vector>

namespace retroforge
{
  /// A mesh made from the surface of another.
  struct RebuiltMesh
  {
    TetMesh                mesh;     ///< its X are the positions
    std::vector<NodeIndex> old_node; ///< for each new node: the old node it is, or invalid_index
  };

  /// Makes the inside of a mesh anew, for meshes whose cells are inverted or too bad for local remeshing.
  /// Only the boundary faces and the positions of their nodes are read, so the state of the cells does not
  /// matter. The faces, their patches and nodes stay as they are, hence the volume too, to rounding. Nodes of
  /// the boundary come first, in their old order; the nodes inside are all new.
  /// The result has passed check_mesh(), but stretched surface triangles leave it with bad angles (0.8
  /// degrees on a cylinder pressed to 0.45 of its height with its first triangles; 17 to 21 on fresh ones): a
  /// pass of local remeshing is meant to follow.
  /// @param X     current positions
  /// @param size  wanted length of edges at a point
  /// Deterministic. To be called on one rank only. Throws Error at `where` when the boundary crosses itself
  /// or the mesher fails.
  RebuiltMesh rebuild_inside(const TetMesh                             &mesh,
                             const NodalVectors<double>                &X,
                             const std::function<double(const Vec3 &)> &size,
                             const std::string                         &where);
} // namespace retroforge
