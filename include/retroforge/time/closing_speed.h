// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/die.h>

#include <algorithm>
#include <vector>

namespace retroforge
{
  /// The fastest that two dies approach each other, or a die the metal that others hold:
  /// max over dies a, b of |v_a - v_b| and |v_a|  [mm/s]. Where one die moves, its speed. It is the same for
  /// one pair of dies however their motion is shared between them, which the speed of the leading die is not.
  inline double closing_speed(const std::vector<DieState<double>> &dies)
  {
    double speed = 0.;
    for (std::size_t a = 0; a < dies.size(); ++a)
    {
      speed = std::max(speed, dies[a].velocity.norm());
      for (std::size_t b = 0; b < a; ++b)
        speed = std::max(speed, (dies[a].velocity - dies[b].velocity).norm());
    }
    return speed;
  }
} // namespace retroforge
