// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/array_view.h>

#include <vector>

namespace retroforge
{
  /// One list per row, stored end to end (compressed rows).
  template <typename T>
  struct Rows
  {
    std::vector<unsigned int> begin = {0}; ///< one entry per row, and the end of the last
    std::vector<T>            entries;

    unsigned int               size() const { return begin.size() - 1; }
    dealii::ArrayView<const T> operator[](const unsigned int row) const
    {
      AssertIndexRange(row, size());
      return {entries.data() + begin[row], begin[row + 1] - begin[row]};
    }
  };
} // namespace retroforge
