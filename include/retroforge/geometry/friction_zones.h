// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/types.h>

#include <tuple>
#include <utility>
#include <vector>

namespace retroforge
{
  /// Friction in a zone of a die: coefficient and bound of its law, as DieState has them.
  template <typename Number>
  struct ZoneFriction
  {
    Number       friction      = Number(0.);
    Number       shear_limit   = Number(0.);
    unsigned int interface_law = 0;

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[friction, shear_limit, interface_law] = self;
      return std::tie(friction, shear_limit, interface_law);
    }
  };

  /// Boxes fixed to a die in which friction is another than the die's own. A point x, where the die stands at the
  /// start of the run, belongs to a box by the weight
  ///   w(x) = prod_i (s((x_i - low_i)/e) - s((x_i - high_i)/e)),
  /// s rising from 0 to 1 over the width e of the edges, half of it on each side of a face: what is 1 in the box
  /// and 0 outside, smoothed. So the weights of boxes that do not overlap are those of their union added up, across
  /// common faces too, and together at most 1; the rest is the die's own.
  struct FrictionZones
  {
    std::vector<std::pair<Vec3, Vec3>> boxes;     ///< lower and upper corners [mm]
    double                             edge = 1.; ///< width e over which friction changes [mm]

    template <typename Number>
    Number weight(unsigned int zone, const Vector3<Number> &x) const;

    /// Returns the gradient of the weight in x [1/mm].
    Vec3 gradient(unsigned int zone, const Vec3 &x) const;
  };
} // namespace retroforge
