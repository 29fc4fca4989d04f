// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/billet/length_unit.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace retroforge
{
  namespace
  {
    constexpr double least_side = 20.;

    SplineCurve in_unit(const LengthUnit &unit, const SplineCurve &curve)
    {
      std::vector<Vec2> points = curve.control_points();
      for (Vec2 &point : points)
        for (unsigned int i = 0; i < 2; ++i)
          point[i] = unit.rounded_from_mm(point[i]);
      return {points, curve.degree(), curve.weights()};
    }
  } // namespace

  // What stands on the border but for rounding counts as beyond it.
  LengthUnit::LengthUnit(const double longest)
      : exponent_(
          static_cast<int>(std::clamp(std::floor(std::log10(longest / least_side) + 1e-9), -300., 300.)))
      , power_(std::pow(10., std::abs(exponent_)))
  {
  }

  double LengthUnit::rounded_from_mm(const double x) const
  {
    char       text[40];
    const auto end   = std::to_chars(text, text + sizeof text, from_mm(x), std::chars_format::scientific, 14);
    double     value = from_mm(x);
    std::from_chars(text, end.ptr, value);
    return value;
  }

  Vec3 LengthUnit::rounded_from_mm(Vec3 x) const
  {
    for (unsigned int i = 0; i < 3; ++i)
      x[i] = rounded_from_mm(x[i]);
    return x;
  }

  LengthUnit unit_of(const CutSolid &solid)
  {
    const bool is_round = solid.is_cylinder || !solid.section.empty();
    return LengthUnit(
      std::max(solid.height, is_round ? 2 * solid.radius : std::max(solid.size[0], solid.size[1])));
  }

  CutSolid in_unit(const LengthUnit &unit, const CutSolid &solid)
  {
    CutSolid scaled    = solid;
    scaled.base_centre = unit.rounded_from_mm(solid.base_centre);
    scaled.size        = unit.rounded_from_mm(solid.size);
    scaled.radius      = unit.rounded_from_mm(solid.radius);
    scaled.height      = unit.rounded_from_mm(solid.height);
    for (Plane &cut : scaled.cuts)
      cut.point = unit.rounded_from_mm(cut.point);
    scaled.section.clear();
    for (const Portion &portion : solid.section)
      scaled.section.push_back({portion.patch, in_unit(unit, portion.curve)});
    return scaled;
  }

  void put_in_mm(const LengthUnit &unit, TetMesh &mesh)
  {
    for (Vec3 &x : mesh.X)
      x = unit.to_mm(x);
    for (Patch &patch : mesh.patches)
      if (patch.symmetry)
        patch.symmetry->point = unit.to_mm(patch.symmetry->point);
  }
} // namespace retroforge
