// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/billet/ring_profile.h>
#include <retroforge/core/types.h>

#include <cmath>

namespace retroforge
{
  /// The seven volumes per radian, with the names of the reference.
  inline double volume_per_radian(const RingProfile &ring, const std::array<double, 4> &mu)
  {
    const double r1 = ring.bore_radius, r6 = ring.base_outer_radius, r7 = ring.base_inner_radius;
    const double z1 = ring.inner_edge_height, z5 = ring.outer_edge_height;
    const auto [m1, m2, m3, m4] = mu;
    return 0.5 * (m2 * m2 - r1 * r1) * (m1 - z1) + 0.4 * (m4 - m2) * (m1 - m3) * (m2 + 2. / 3. * m4) +
           0.5 * (m4 * m4 - m2 * m2) * (m3 - z1) + 0.5 * (z1 - z5) * (m4 * m4 - r6 * r6) +
           1. / 12. * (m4 - r6) * z5 * (3. * m4 + 5. * r6) + 0.5 * (r6 * r6 - r7 * r7) * z1 +
           (r7 - r1) * z1 * ((M_PI / 4. - 1. / 3.) * r7 + r1 / 3.);
  }

  /// How far a point, in the ring's own axes, is from the equation of a portion.
  inline double ring_defect(const std::string &patch, const RingProfile &ring, const Vec3 &x)
  {
    const double r = std::hypot(x[0], x[1]), z = x[2];
    const auto [m1, m2, m3, m4] = ring.mu;
    const double r1 = ring.bore_radius, r6 = ring.base_outer_radius, r7 = ring.base_inner_radius;
    const double z1 = ring.inner_edge_height, z5 = ring.outer_edge_height;
    if (patch == "bottom")
      return std::abs(z);
    if (patch == "top")
      return std::abs(z - m1);
    if (patch == "side inner")
      return std::abs(r - r1);
    if (patch == "side outer")
      return std::abs(r - m4);
    // Solved for r where the curve ends upright.
    if (patch == "edge top outer")
      return std::abs(r - m4 - (m2 - m4) * std::pow((z - m3) / (m1 - m3), 2));
    if (patch == "edge bottom outer")
      return std::abs(z - z5 * std::pow((r - r6) / (m4 - r6), 2));
    return std::abs(std::hypot((r - r7) / (r7 - r1), (z - z1) / z1) - 1.) * z1;
  }

} // namespace retroforge
