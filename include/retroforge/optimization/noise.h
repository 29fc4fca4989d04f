// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <vector>

namespace retroforge
{
  /// How much values of neighbouring designs differ by more than their gradients say.
  struct Noise
  {
    double              objective = 0.; ///< in its unit
    std::vector<double> values    = {}; ///< of each value of the problem, in its unit; empty: not measured
  };
} // namespace retroforge
