// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/output/time_left.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  void TimeLeft::add(const double step, const double seconds)
  {
    constexpr double memory = 0.1; // of the stroke
    const double     fading = std::exp(-step / (memory * stroke_));
    time_                   = fading * time_ + seconds;
    path_                   = fading * path_ + step;
  }

  double TimeLeft::seconds(const double stroke) const
  {
    return time_ / path_ * std::max(stroke_ - stroke, 0.);
  }
} // namespace retroforge
