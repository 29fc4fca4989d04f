// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/tet_mesh.h>
#include <retroforge/remeshing/remeshing_parameters.h>

#include <vector>

namespace retroforge
{
  /// Cells that a remeshing left below the trigger angle, at the positions the mesh was made with.
  /// Pass them to needs_remeshing(), or it asks for the impossible again.
  std::vector<bool> frozen_cells(const TetMesh &mesh, const RemeshingParameters &parameters);

  /// Returns whether a dihedral angle is below the trigger angle. Not counted are angles between two boundary
  /// faces of one cell (the shape of the workpiece, which remeshing keeps), and frozen cells, unless they
  /// have lost half the angle they had at mesh.X. `frozen` may be empty.
  bool needs_remeshing(const TetMesh              &mesh,
                       const NodalVectors<double> &X,
                       const RemeshingParameters  &parameters,
                       const std::vector<bool>    &frozen);

  /// Smallest dihedral angle in degrees, without those between two boundary faces of one cell.
  double minimum_free_angle(const TetMesh &mesh, const NodalVectors<double> &X);
} // namespace retroforge
