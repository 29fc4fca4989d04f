// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/run/power_balance.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  double PowerBalance::add(const IncrementRecord &record)
  {
    const double energy = record.energy(), balance = energy > 0. ? record.closing_work / energy : 0.;
    work_ += record.closing_work;
    energy_ += energy;
    sizes_.push_back(std::abs(balance));
    if (sizes_.back() > largest_)
    {
      largest_ = sizes_.back();
      stroke_  = record.stroke + record.step;
    }
    return balance;
  }

  Summary::PowerBalance PowerBalance::summary() const
  {
    if (sizes_.empty() || !(energy_ > 0.))
      return {};
    std::vector<double> sizes = sizes_;
    const auto          most  = sizes.begin() + (sizes.size() - 1) * 19 / 20;
    std::nth_element(sizes.begin(), most, sizes.end());
    return {work_ / energy_, *most, largest_, stroke_};
  }
} // namespace retroforge
