// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/remeshing/peeled_mesh.h>

#include <optional>

namespace retroforge
{
  /// Takes away the slivers at the surface of a mesh that remeshing left: cells with a face or
  /// all nodes on it, and flatter than a degree (tet_quality() below sin 1°). Such a cell is the closed crack or the film that the
  /// side of the workpiece leaves as it folds at the edge of a die, or the neck of a lip that the edge shaves off. No change inside cures it, because its
  /// faces are the body's own, and ridges, whose nodes stay; and no increment is short enough for it.
  ///
  /// The sliver itself goes where the boundary stays a surface without it: its faces are exchanged for the
  /// two opposite ones, almost in their place. Else those beside it at the surface go first, the smallest
  /// first: the film's end; and where none of them may, thin metal around, see thin_cells_near(). Where that would be more than the cube of the wanted length, or than is allowed
  /// in all, or metal in a plane of symmetry, the sliver stays. Nothing when none goes. What is lost of the
  /// volume is for the volume correction.
  /// @param X     current positions
  /// @param size  wanted length of edges at a point
  /// @param most  what may be taken away in all [mm^3]
  /// Deterministic. To be called with the same arguments on all ranks or on one.
  std::optional<RepairedMesh> without_slivers(const TetMesh                             &mesh,
                                              const NodalVectors<double>                &X,
                                              const std::function<double(const Vec3 &)> &size,
                                              double                                     most);
} // namespace retroforge
