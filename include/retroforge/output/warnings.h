// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/output/summary.h>

namespace retroforge
{
  /// Whether the surface was deeper in a die than needs no word, or many of its edges spanned corners of dies.
  bool is_in_die(const Summary::Depth &deepest, const Summary::Spanned &spanned, double largest_depth);

  /// Returns the warnings that a user must know to trust the numbers of a finished run: each a sentence or
  /// two, with a remedy.
  /// @param largest_depth  of the surface in a die, over the element size, that needs no word
  /// @param untouched      dies that pressed no node
  std::vector<std::string>
  warnings_of(const Summary &summary, double largest_depth, const std::vector<std::string> &untouched);
} // namespace retroforge
