// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <vector>

namespace retroforge
{
  /// The shortest x for which  | sum_i x_i columns_i - right |  is least. A column that is zero beside the
  /// others, or depends on them, makes no x infinite: it gets none of it, or its share.
  /// @param columns  each as long as `right`; there may be more of them than it has entries
  std::vector<double> least_squares(const std::vector<std::vector<double>> &columns,
                                    const std::vector<double>              &right);
} // namespace retroforge
