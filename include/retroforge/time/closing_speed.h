// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/dual.h>
#include <retroforge/geometry/die.h>

#include <cmath>
#include <vector>

namespace retroforge
{
  /// The fastest that two dies approach each other, or a die the metal that others hold:
  /// max over dies a, b of |v_a - v_b| and |v_a|  [mm/s]. Where one die moves, its speed. It is the same for
  /// one pair of dies however their motion is shared between them, which the speed of the leading die is not.
  template <typename Number>
  Number closing_speed(const std::vector<DieState<Number>> &dies)
  {
    using std::sqrt;
    Number     square(0.);
    const auto compare = [&square](const Vector3<Number> &v) {
      if (const Number found = v * v; value_of(found) > value_of(square))
        square = found;
    };
    for (std::size_t a = 0; a < dies.size(); ++a)
    {
      compare(dies[a].velocity);
      for (std::size_t b = 0; b < a; ++b)
        compare(dies[a].velocity - dies[b].velocity);
    }
    return value_of(square) > 0. ? Number(sqrt(square)) : square; // at rest its derivative is not finite
  }
} // namespace retroforge
