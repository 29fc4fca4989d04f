// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/material/material.h>
#include <retroforge/mesh/tet_mesh.h>
#include <retroforge/steps/workpiece_state.h>

/// @file
/// What laws of the metal see of the workpiece. A member of PointState is found here, and nowhere else.
namespace retroforge
{
  /// Returns the state of the metal in each cell; what the workpiece's does not tell is the metal's before the
  /// stroke. The temperature of a cell is the mean of its nodes'.
  template <typename Number>
  std::vector<PointState<Number>> point_states(const TetMesh                   &mesh,
                                               const PointState<Number>        &initial,
                                               const WorkpieceState<3, Number> &state);

  /// Reverse of point_states(): adds to the derivatives in the state before the stroke, and to the costate.
  /// @param bar  derivatives in the state of the metal in each cell
  void reverse_point_states(const TetMesh                         &mesh,
                            const std::vector<PointState<double>> &bar,
                            PointState<double>                    &initial_bar,
                            WorkpieceState<3, double>             &costate);
} // namespace retroforge
