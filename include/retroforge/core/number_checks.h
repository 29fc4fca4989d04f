// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/numbers.h>

namespace retroforge
{
  /// Checks a list of numbers that a parameter file gives for a law or the like.
  /// @param info   how users know the numbers that there are
  /// @param where  the setting
  /// @param owner  what they belong to, as a message says it: "the law 'Norton-Hoff'"
  /// @throws Error  where there are more or fewer, or one is not in its range
  void check_numbers(const std::vector<double>     &numbers,
                     const std::vector<NumberInfo> &info,
                     const std::string             &where,
                     const std::string             &owner);
} // namespace retroforge
