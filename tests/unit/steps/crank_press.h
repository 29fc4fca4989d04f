// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/steps/press_motion.h>

#include <cmath>

namespace retroforge
{
  /// A press driven by a crank with a long rod: the ram is r (1 + cos a) above its lowest point when the
  /// crank has turned by a, and passes the middle of its way at the dies' own speed, r da/dt. It is known to
  /// the tests only.
  class CrankPress : public PressMotionOf<CrankPress>
  {
  public:
    /// The radius r of the crank [mm], and how high the ram is at the start of the stroke [mm].
    static constexpr unsigned int radius = 0, height = 1;

    std::vector<NumberInfo> info() const override { return {{"radius", "mm"}, {"height", "mm"}}; }

    /// r times the angle that the crank turns.
    template <typename Number>
    Number compute_path(const std::vector<Number> &numbers, const double stroke, const double step) const
    {
      using std::acos;
      const Number &r     = numbers[radius];
      const auto    angle = [&](const double gone) {
        return Number(acos(Number((numbers[height] - gone) / r - 1.)));
      };
      return r * Number(angle(stroke + step) - angle(stroke));
    }
  };

  /// Makes the motion known as `crank`, and returns its number.
  inline unsigned int add_crank_press()
  {
    add_press_motion("crank", std::make_unique<CrankPress>());
    return find_press_motion("crank", "test");
  }
} // namespace retroforge
