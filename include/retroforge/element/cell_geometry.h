// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/types.h>
#include <retroforge/material/material_law.h>

#include <array>

namespace retroforge
{
  template <typename Number>
  using Four = std::array<Number, 4>;

  /// Corners of the six edges of a tetrahedron, in the order of deal.II's lines.
  inline constexpr unsigned int tet_edge_corners[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};

  /// Volume [mm^3] and gradients g_a = grad lambda_a [1/mm] of a tetrahedron.
  template <typename Number>
  struct CellGeometry
  {
    Number                volume;
    Four<Vector3<Number>> g;
  };

  /// Derivatives of a scalar of the cell in everything that is not an unknown.
  struct CellSensitivity
  {
    Four<Vec3>          X = {};
    MaterialLaw<double> law;
  };

  template <typename Number>
  CellGeometry<Number> cell_geometry(const Four<Vector3<Number>> &X);

  /// [mm^3]
  template <typename Number>
  Number cell_volume(const CellGeometry<Number> &geometry)
  {
    return geometry.volume;
  }

  /// Adds to X_bar the pull-back of (volume_bar, g_bar) through cell_geometry:  dg_a = -sum_c (g_a·dX_c) g_c.
  void reverse_cell_geometry(const CellGeometry<double> &geometry,
                             double                      volume_bar,
                             const Four<Vec3>           &g_bar,
                             Four<Vec3>                 &X_bar);
} // namespace retroforge
