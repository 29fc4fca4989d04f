// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/linear_algebra/node_matrix.h>

namespace retroforge
{
  /// Returns the nodes that each of these meets, of n points of a ring: itself, its neighbours and one across.
  inline Rows<unsigned int> ring_neighbours(const NodeRange &range, const unsigned int n)
  {
    Rows<unsigned int> rows;
    for (unsigned int a = range.begin; a < range.end; ++a)
    {
      for (const unsigned int b : {a, a + 1, a + n - 1, a + n / 2})
        rows.entries.push_back(b % n);
      rows.begin.push_back(rows.entries.size());
    }
    return rows;
  }
} // namespace retroforge
