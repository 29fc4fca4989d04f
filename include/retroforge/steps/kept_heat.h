// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/tet_mesh.h>
#include <retroforge/steps/workpiece_state.h>

/// @file
/// A change of mesh keeps heat: J, which takes temperatures over, keeps linear fields but not the mean of others. What
/// the mean over the volume lacks is made up for by a part of the way to the highest temperature there was, what is too
/// much by one to the lowest,
///   T_k += lambda (T_m - T_k),  lambda = (mean before - mean after)/(T_m - mean after +- 0.1 K),
/// so that no node leaves the range of the temperatures before. The tenth of a kelvin, of its sign, lets uniform
/// temperatures be.
namespace retroforge
{
  /// Temperatures on a mesh at positions X.
  template <typename Number>
  struct HeatOnMesh
  {
    const TetMesh              &mesh;
    const NodalVectors<Number> &X;
    const std::vector<Number>  &T; ///< of the nodes [C]
  };

  /// Returns the temperatures after, corrected.
  /// @param after  as J makes them
  template <typename Number>
  std::vector<Number> keep_heat(const HeatOnMesh<Number> &before, const HeatOnMesh<Number> &after);

  /// Reverse of keep_heat: adds the derivatives in what was before, and in positions after.
  /// @param bar  derivatives in the corrected temperatures
  /// @return those in the temperatures as J makes them
  std::vector<double> reverse_keep_heat(const HeatOnMesh<double>  &before,
                                        const HeatOnMesh<double>  &after,
                                        const std::vector<double> &bar,
                                        NodalVectors<double>      &X_before_bar,
                                        std::vector<double>       &T_before_bar,
                                        NodalVectors<double>      &X_after_bar);
} // namespace retroforge
