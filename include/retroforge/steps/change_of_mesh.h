// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/record/increment_record.h>
#include <retroforge/steps/workpiece_state.h>

/// @file
/// The step that takes the workpiece from one mesh to the next. What happens to a member of the state follows
/// from its kind: positions X' = J X + c, one number per node q' = J q, one per cell transfer_cells().
namespace retroforge
{
  /// Returns the state on the new mesh; on dual numbers its tangent.
  template <typename Number>
  WorkpieceState<3, Number>
  change_mesh(const TetMesh &old_mesh, const RemeshRecord &remesh, const WorkpieceState<3, Number> &before);

  /// Returns the costate on the old mesh of one on the new mesh: the reverse of change_mesh().
  /// @param before  the state on the old mesh
  WorkpieceState<3, double> reverse_change_mesh(const TetMesh                   &old_mesh,
                                                const RemeshRecord              &remesh,
                                                const WorkpieceState<3, double> &before,
                                                const WorkpieceState<3, double> &costate);
} // namespace retroforge
