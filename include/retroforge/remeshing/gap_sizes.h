// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/die.h>
#include <retroforge/mesh/tet_mesh.h>

#include <limits>

namespace retroforge
{
  /// Wanted length of edges in a narrow gap: so many elements over its thickness,
  ///
  ///   s(x) = t(x)/n,    t = min over pairs of walls (delta_a + delta_b) / (2 c - 1),    c = -n_a·n_b > 1/2,
  ///
  /// delta the signed distances of x to two walls and n their normals there, which face one another: walls at
  /// 60 degrees and more make a corner, not a gap. Walls are dies; a plane of symmetry is one beside a die,
  /// and the gap is then that of the whole part, 2 (delta_a + delta_b).
  ///
  /// Nothing is cached: what changes is where dies are to one another, and the gap depends on nothing else.
  class GapSizes
  {
  public:
    /// States of all dies.
    using DieStates = std::vector<DieState<double>>;

    /// @param elements  n, over the thickness; 0: gaps ask for nothing
    /// @param smallest  lengths are not below; gaps thinner than a tenth of it are closed [mm]
    /// @param planes    of symmetry; normals point out of the workpiece
    GapSizes(const std::vector<Die> &dies, std::vector<Plane> planes, double elements, double smallest);

    bool enabled() const { return elements_ > 0.; }

    /// Returns s(x) or what is larger than `upper` [mm].
    double operator()(const Vec3 &x, const DieStates &states, double upper) const;

    /// Returns a length that s is not smaller than within a distance of x; exact up to `upper` [mm].
    double below(const Vec3 &x, double distance, const DieStates &states, double upper) const;

    /// Returns whether gaps ask for less than `upper` at a point.
    bool narrow(const Vec3 &x, const DieStates &states, const double upper) const
    {
      return (*this)(x, states, upper) < upper;
    }

  private:
    struct Wall
    {
      double delta;
      Vec3   n; ///< into the wall
      bool   is_symmetry;
    };

    std::vector<Wall> walls(const Vec3 &x, const DieStates &states, double reach) const;

    const std::vector<Die> &dies_;
    std::vector<Plane>      planes_;
    double                  elements_, smallest_;
  };
} // namespace retroforge
