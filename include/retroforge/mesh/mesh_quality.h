// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/types.h>

#include <array>
#include <vector>

namespace retroforge
{
  /// Positions of the four corners of a tetrahedron.
  using TetCorners = std::array<Vec3, 4>;

  /// The corners of one cell, at the given positions of the nodes.
  TetCorners corners(const std::array<NodeIndex, 4> &cell, const NodalVectors<double> &X);

  /// Signed volume  V = (x1-x0)x(x2-x0)·(x3-x0) / 6,  negative when the tetrahedron is inverted.
  double tet_volume(const TetCorners &x);

  /// Smallest angle between two faces of a tetrahedron, in degrees: 70.53 for the regular one,
  /// 0 for a flat or inverted one.
  double minimum_dihedral_angle(const TetCorners &x);

  /// Quality  q = min( min_edges sin(dihedral angle), sqrt2 6V / l_rms^3 ),  dimensionless, with l_rms the
  /// root mean square of the six edges. It is 0.943 for the regular tetrahedron, zero for a flat one and
  /// negative for an inverted one. The sine sees slivers and needles alike, the second term orders what
  /// has no sines: tetrahedra that are turned inside out.
  double tet_quality(const TetCorners &x);

  /// Volume of the mesh, sum of the signed volumes of its cells.
  double volume(const std::vector<std::array<NodeIndex, 4>> &cells, const NodalVectors<double> &X);

  /// Smallest dihedral angle of all cells, in degrees.
  double minimum_dihedral_angle(const std::vector<std::array<NodeIndex, 4>> &cells,
                                const NodalVectors<double>                  &X);

  /// Smallest quality of all cells, see tet_quality().
  double minimum_quality(const std::vector<std::array<NodeIndex, 4>> &cells, const NodalVectors<double> &X);
} // namespace retroforge
