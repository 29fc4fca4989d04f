// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/tet_mesh.h>

#include <string>
#include <vector>

namespace retroforge
{
  /// Reads linear tetrahedra from a Gmsh file (.msh, see read_msh_file()), without Gmsh. Physical surfaces
  /// become patches, named as in the file or, without a name, by their number; outer faces on no physical
  /// surface become the patch `surface`. Triangles inside the volume are ignored. When all tetrahedra are
  /// inverted they are turned. Patches whose name or number is in `symmetry_patches` become symmetry planes.
  /// The mesh is not checked (see check_mesh()). Throws Error for what cannot be read.
  TetMesh read_msh(const std::string &file_name, const std::vector<std::string> &symmetry_patches);
} // namespace retroforge
