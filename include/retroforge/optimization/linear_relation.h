// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <string>
#include <vector>

namespace retroforge
{
  /// lower <= sum_j weights_j mu_j <= upper,  an equation where both are the same.
  struct LinearRelation
  {
    std::string         text; ///< as the user wrote it
    std::vector<double> weights;
    double              lower, upper; ///< may be infinite

    double value(const std::vector<double> &mu) const;
    bool   is_equation() const { return lower == upper; }
    /// Returns the excess over the bounds; 0 within them.
    double excess(const std::vector<double> &mu) const;
  };

  /// Reads `2 a/x - b/y <= 5`: terms `NAME`, `NUMBER NAME`, `NUMBER * NAME` or `NUMBER`, joined by ` + ` and
  /// ` - `, on both sides of one of <=, >=, =.
  /// @param names  those that may stand in it, in the order of the weights
  /// @throws Error  for what is no such relation, or a name that is not among them
  LinearRelation read_relation(const std::string &text, const std::vector<std::string> &names);
} // namespace retroforge
