// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/whole_part.h>
#include <retroforge/objective/sector.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  Sector::Sector(const TetMesh &mesh) : planes_(symmetry_planes(mesh)) {}

  bool Sector::contains(const Vec3 &x) const
  {
    return std::all_of(planes_.begin(), planes_.end(), [&](const Plane &plane) {
      const double rounding = 1e-9 * (x.norm() + plane.point.norm());
      return (x - plane.point) * plane.normal <= rounding;
    });
  }

  double Sector::share(const Vec3 &x, const Vec3 &edges) const
  {
    double share = 1.;
    for (const Plane &plane : planes_)
    {
      double width = 0.;
      for (unsigned int i = 0; i < 3; ++i)
        width += std::abs(plane.normal[i]) * edges[i];
      share *= std::clamp(0.5 - (x - plane.point) * plane.normal / width, 0., 1.);
    }
    return share;
  }

  Box Sector::clipped(Box box) const
  {
    for (const Plane &plane : planes_)
      for (unsigned int i = 0; i < 3; ++i)
        if (std::abs(plane.normal[i]) > 1. - 1e-12)
        {
          double &side = plane.normal[i] > 0. ? box.second[i] : box.first[i];
          side = plane.normal[i] > 0. ? std::min(side, plane.point[i]) : std::max(side, plane.point[i]);
        }
    return box;
  }
} // namespace retroforge
