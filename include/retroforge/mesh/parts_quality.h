// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/replicated_entries.h>
#include <retroforge/mesh/tet_mesh.h>

/// @file
/// Of a mesh whose cells the ranks share, what mesh_quality.h says of one: each looks at its own. Collective.
namespace retroforge
{
  /// Sum of the signed volumes of the cells [mm^3].
  double volume(const TetMesh &mesh, const NodalVectors<double> &X, const ReplicatedEntries &cells);

  /// Smallest quality of all cells, see tet_quality().
  double minimum_quality(const TetMesh &mesh, const NodalVectors<double> &X, const ReplicatedEntries &cells);
} // namespace retroforge
