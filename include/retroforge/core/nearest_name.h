// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <string>
#include <vector>

namespace retroforge
{
  /// Number of letters to insert, delete, replace or swap with their neighbour to turn `a` into `b`;
  /// upper and lower case count as equal.
  unsigned int edit_distance(const std::string &a, const std::string &b);

  /// The known name a user most likely meant by `wrong`, or "" when none is within `max_distance` edits.
  /// The first of equally near names wins.
  std::string
  nearest_name(const std::string &wrong, const std::vector<std::string> &known, unsigned int max_distance);

  /// Edits a word of this length may be off and still be taken for a typing error.
  unsigned int tolerated_edits(const std::string &word);

  /// `a, b, c`
  std::string join(const std::vector<std::string> &words);
} // namespace retroforge
