// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/index_set.h>

namespace retroforge
{
  /// Nodes of a space by their numbers in matrices, [begin, end) of n of which are this rank's.
  struct NodeRange
  {
    unsigned int begin = 0, end = 0, n = 0;

    unsigned int n_owned() const { return end - begin; }
    bool         owns(const unsigned int number) const { return begin <= number && number < end; }

    /// Returns the degrees of freedom that are this rank's, `width` to a node.
    dealii::IndexSet dofs(const unsigned int width) const
    {
      dealii::IndexSet set(width * n);
      set.add_range(width * begin, width * end);
      return set;
    }
  };
} // namespace retroforge
