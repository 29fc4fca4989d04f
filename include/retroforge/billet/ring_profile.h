// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/parameter_handler.h>

#include <retroforge/billet/section.h>

#include <algorithm>
#include <array>

namespace retroforge
{
  /// Meridian section of a ring with seven control points (r_i, z_i), z from its base, and seven portions:
  ///
  ///     2 (r1, mu1) --- 3 (mu2, mu1)      1-2 bore, straight          r = r1
  ///     |                  \              2-3 top, straight           z = mu1
  ///     |               4 (mu4, mu3)      3-4 upper outer edge  z = mu3 + (mu1-mu3) sqrt((r-mu4)/(mu2-mu4))
  ///     1 (r1, z1)         |              4-5 outer side, straight    r = mu4
  ///      \              5 (mu4, z5)       5-6 lower outer edge  z = z5 ((r-r6)/(mu4-r6))^2
  ///     7 (r7, 0) --- 6 (r6, 0)           6-7 base, straight          z = 0
  ///                                       7-1 lower inner edge, a quarter of an ellipse about (r7, z1)
  ///
  /// Portion 3-4 ends upright at 4, portion 5-6 level at 6, portion 7-1 level at 7 and upright at 1.
  /// mu1 to mu4 can change, the other measures stay.  @cite Laroussi2003, Eqs. (142)-(147), Fig. 34
  struct RingProfile
  {
    double                bore_radius       = 10; ///< r1 = r2
    double                inner_edge_height = 3;  ///< z1
    double                outer_edge_height = 3;  ///< z5
    double                base_outer_radius = 20; ///< r6
    double                base_inner_radius = 13; ///< r7
    std::array<double, 4> mu                = {{45, 19, 30, 25.5}};

    void add_parameters(dealii::ParameterHandler &prm);

    /// Returns the rule that the measures break with these mu, in words; empty when none.
    std::string complaint(const std::array<double, 4> &mu) const;

    Section section() const;

    /// Up to this height above the base nothing moves along z.
    double fixed_height() const { return std::max(inner_edge_height, outer_edge_height); }
  };
} // namespace retroforge
