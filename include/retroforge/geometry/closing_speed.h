// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/dual.h>
#include <retroforge/geometry/die.h>

#include <cmath>
#include <vector>

namespace retroforge
{
  /// The two dies that approach each other fastest, or the die and the metal that others hold.
  struct ClosingDies
  {
    unsigned int die   = invalid_index; ///< invalid_index: no die moves
    unsigned int other = invalid_index; ///< invalid_index: the metal

    /// Returns the velocity by which they close [mm/s].
    template <typename Number>
    Vector3<Number> velocity(const std::vector<DieState<Number>> &dies) const
    {
      if (die == invalid_index)
        return Vector3<Number>();
      return other == invalid_index ? dies[die].velocity
                                    : Vector3<Number>(dies[die].velocity - dies[other].velocity);
    }
  };

  /// Returns those for which  max over dies a, b of |v_a - v_b| and |v_a|  is attained.
  template <typename Number>
  ClosingDies closing_dies(const std::vector<DieState<Number>> &dies)
  {
    ClosingDies closing;
    double      largest = 0.;
    const auto  compare = [&](const ClosingDies &some) {
      const Vector3<Number> v = some.velocity(dies);
      if (const double square = value_of(Number(v * v)); square > largest)
      {
        largest = square;
        closing = some;
      }
    };
    for (unsigned int a = 0; a < dies.size(); ++a)
    {
      compare({a, invalid_index});
      for (unsigned int b = 0; b < a; ++b)
        compare({a, b});
    }
    return closing;
  }

  /// The fastest that two dies approach each other, or a die the metal that others hold [mm/s]: where one die
  /// moves, its speed. It is the same for one pair of dies however their motion is shared between them, which
  /// the speed of the leading die is not.
  template <typename Number>
  Number closing_speed(const std::vector<DieState<Number>> &dies)
  {
    using std::sqrt;
    const Vector3<Number> v      = closing_dies(dies).velocity(dies);
    const Number          square = v * v;
    return value_of(square) > 0. ? Number(sqrt(square)) : square; // at rest its derivative is not finite
  }
} // namespace retroforge
