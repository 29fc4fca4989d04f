// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

namespace retroforge
{
  /// Temperatures that input may have [C]: above the first, at most the second, where no metal is forged.
  constexpr double absolute_zero = -273.15, hottest = 2000.;
} // namespace retroforge
