// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/adjoint/objective_sensitivity.h>
#include <retroforge/design/design.h>

namespace retroforge
{
  /// The derivatives by all nodes of the billet (sensitivity_nodes.csv), and by all vertices of each die that
  /// has some (sensitivity_die_NAME_nodes.csv): tables with one row per node, its number, its position at the
  /// start of the run [mm], and the three derivatives of each objective [its unit per mm], all digits.
  ///
  /// Of a billet that is the mesh of a file, rows stand in the order of the file's nodes, with their numbers
  /// there; nodes of no tetrahedron have zeros. Other billets are in the order of write_msh(). Vertices of a
  /// die have the order in which its triangles, or its STL file, first name them.
  /// @param process  where the dies stand     @throws Error  if a file cannot be written
  void write_nodal_gradients(const std::string                       &directory,
                             const TetMesh                           &billet,
                             const NodalVectors<double>              &X_0,
                             const std::vector<Die>                  &dies,
                             const Process<double>                   &process,
                             const std::vector<ObjectiveSensitivity> &sensitivities);
} // namespace retroforge
