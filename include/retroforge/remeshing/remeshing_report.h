// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <cstddef>

namespace retroforge
{
  /// Statistics of a remeshing. Lengths are relative to the wanted edge length, volumes in length^3.
  struct RemeshingReport
  {
    unsigned int n_length_collapses  = 0;
    unsigned int n_length_splits     = 0;
    unsigned int n_edge_removals     = 0; ///< in the interior
    unsigned int n_surface_flips     = 0; ///< edge removals on the boundary
    unsigned int n_face_flips        = 0;
    unsigned int n_smoothings        = 0;
    unsigned int n_quality_collapses = 0;
    unsigned int n_quality_splits    = 0;

    unsigned int n_nodes_before = 0;
    unsigned int n_nodes_after  = 0;
    unsigned int n_nodes_kept   = 0; ///< new nodes that are old ones
    unsigned int n_cells_after  = 0;
    /// Cells that stay below the goal quality.
    unsigned int n_cells_left_bad = 0;

    double quality_before = 0; ///< smallest, see tet_quality()
    double quality_after  = 0;
    double angle_before   = 0; ///< smallest dihedral angle, degrees

    double volume_before      = 0;
    double volume_uncorrected = 0;
    double volume_after       = 0;
    /// Farthest a node is moved by the volume correction.
    double largest_correction = 0;
  };
} // namespace retroforge
