// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/billet/gmsh_mesher.h>

namespace retroforge
{
  /// Gmsh and its geometry kernel know absolute tolerances: 1e-7 and the like, in whatever unit. So bodies
  /// are meshed in a unit of 10^e mm in which their longest side is 20 or more and less than 200: bodies that
  /// differ by a power of ten have the same mesh, and those of common size are meshed in mm.
  class LengthUnit
  {
  public:
    /// @param longest  side of the body, > 0 [mm]
    explicit LengthUnit(double longest);

    /// Convert with one rounding each, none where the unit is 1 mm.
    double from_mm(double x) const { return exponent_ >= 0 ? x / power_ : x * power_; }
    Vec3   from_mm(const Vec3 &x) const { return exponent_ >= 0 ? x / power_ : x * power_; }
    double to_mm(double x) const { return exponent_ >= 0 ? x * power_ : x / power_; }
    Vec3   to_mm(const Vec3 &x) const { return exponent_ >= 0 ? x * power_ : x / power_; }

    /// Convert from mm, rounded to the fifteen digits that the decimal numbers of a parameter file keep:
    /// measures that differ by a power of ten become the same to the last bit.
    double rounded_from_mm(double x) const;
    Vec3   rounded_from_mm(Vec3 x) const;

  private:
    int    exponent_ = 0;
    double power_    = 1.; ///< 10^|e|
  };

  /// Returns the unit of a box, cylinder or body of revolution.
  LengthUnit unit_of(const CutSolid &solid);

  /// Returns the solid in the unit, its measures rounded.
  CutSolid in_unit(const LengthUnit &unit, const CutSolid &solid);

  /// Converts nodes and symmetry planes back to mm.
  void put_in_mm(const LengthUnit &unit, TetMesh &mesh);
} // namespace retroforge
