// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/output/summary.h>
#include <retroforge/record/increment_record.h>

#include <vector>

namespace retroforge
{
  /// Statistics of the work that dies do on gaps that close (spent_power.h), over a run.
  class PowerBalance
  {
  public:
    /// Returns that of an increment over its energy; 0 where no energy was spent.
    double add(const IncrementRecord &record);

    Summary::PowerBalance summary() const;

  private:
    double              work_ = 0., energy_ = 0., largest_ = 0., stroke_ = 0.;
    std::vector<double> sizes_;
  };
} // namespace retroforge
