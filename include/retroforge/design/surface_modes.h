// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/triangle_surface.h>

namespace retroforge
{
  /// A surface of triangles whose points move by one number each.
  struct MovingSurface
  {
    /// A sum of points' values times factors that is to vanish.
    using Tie = std::vector<std::pair<unsigned int, double>>;

    NodalVectors<double>  points; ///< [mm]
    std::vector<Triangle> triangles;
    std::vector<bool>     held; ///< points that stay; empty: none
    std::vector<Tie>      ties; ///< each weighs as much as its first point

    bool                moves(const unsigned int point) const { return held.empty() || !held[point]; }
    unsigned int        n_moving() const;
    std::vector<double> masses() const; ///< masses of the points: a third of the areas around [mm^2]
    double              area() const;   ///< mass of the points that move [mm^2]
  };

  /// The modes of a surface, from the smoothest on,
  ///   L phi_i = lambda_i M phi_i,    phi_i^T M phi_i = area / (1 + l^2 lambda_i),
  /// L and M its stiffness (cotangents) and lumped mass in linear elements. They are orthogonal in the
  /// Sobolev metric  x^T (M + l^2 L) y,  in which each measures the area: a coefficient of a mode in mm is
  /// the move's length in the norm
  ///   |d|^2 = (1/area) ∫ d^2 + l^2 |grad d|^2,
  /// whatever the mesh. Where points are held the modes vanish; where the surface ends they have no slope.
  /// Fields that break a tie are no modes: a tie costs more than any that is asked for.
  ///
  /// @param n       how many; at most as many as points that move and begin no tie
  /// @param length  l [mm]; 0: a quarter of the root of the area
  /// @return values at the points of each mode, the largest of them positive
  std::vector<std::vector<double>> surface_modes(const MovingSurface &surface, unsigned int n, double length);

  /// The part of a direction that lies in all planes with these unit normals.
  Vec3 in_planes(Vec3 d, const std::vector<Vec3> &normals);

  /// The surface's modes are found in a full matrix of this many points that move.
  constexpr unsigned int most_moving_points = 4000;
} // namespace retroforge
