// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/tet_mesh.h>

#include <string>

namespace retroforge
{
  /// A workpiece as a Gmsh file (version 2.2, ASCII, all digits), each patch a physical surface of its name:
  /// a billet for another run. Nodes have the order and the numbers of the file that the mesh was read from,
  /// others are counted from 1.  @throws Error  if it cannot be written
  void write_msh(const std::string &file, const TetMesh &mesh, const NodalVectors<double> &X);

  /// The boundary of a workpiece, planes of symmetry included, as a binary STL file: closed, normals
  /// outwards.
  /// @throws Error  if it cannot be written
  void write_boundary_stl(const std::string &file, const TetMesh &mesh, const NodalVectors<double> &X);
} // namespace retroforge
