// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/types.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace retroforge
{
  /// Plane through `point`; `normal` has length one and points out of the workpiece.
  struct Plane
  {
    Vec3 point;
    Vec3 normal;
  };

  /// A named part of the workpiece's boundary. A patch with a symmetry plane is not surface
  /// in the sense of contact: it carries  v·n = 0  and no shear.
  struct Patch
  {
    std::string          name;
    std::optional<Plane> symmetry;
  };

  /// Triangle of the boundary; its nodes turn counter-clockwise seen from outside.
  struct BoundaryFace
  {
    std::array<NodeIndex, 3> nodes;
    unsigned int             patch;
  };

  /// The nodes of the file that a mesh was read from, in the file's order, those of no tetrahedron too.
  struct FileNodes
  {
    std::vector<std::size_t> tags;  ///< their numbers in the file
    std::vector<NodeIndex>   nodes; ///< and in the mesh; invalid_index: of no tetrahedron
    NodalVectors<double>     X;     ///< where the mesh was made [mm]
  };

  /// The tetrahedral mesh of a workpiece: connectivity, patches, and the positions of the nodes
  /// when it was made. The same on every rank. Positions during a run live outside the mesh.
  ///
  /// Cells are positively oriented:  (X1-X0)x(X2-X0)·(X3-X0) > 0.
  struct TetMesh
  {
    NodalVectors<double>                  X;
    std::vector<std::array<NodeIndex, 4>> cells;
    std::vector<BoundaryFace>             faces;
    std::vector<Patch>                    patches;
    /// What of its file was mended or left out, a sentence each; where the mesh was made, on one rank.
    std::vector<std::string> remarks = {};
    FileNodes                of_file; ///< empty, unless it is the mesh of a file as it stands there

    unsigned int n_nodes() const { return X.size(); }
    unsigned int n_cells() const { return cells.size(); }

    bool is_surface(const BoundaryFace &face) const { return !patches[face.patch].symmetry; }
  };
} // namespace retroforge
