// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/linear_algebra/types.h>

#include <vector>

namespace retroforge
{
  /// A copy of the blocks of a matrix whose rows and columns come by nodes (NodeMatrix), of velocities three to
  /// a node and of pressures one: the numbers of a block share one column index, and the columns of a block of
  /// three rows are vectors for the processor.
  template <typename Number>
  struct NodeBlocks
  {
    unsigned int              height, width; ///< of a block
    std::vector<unsigned int> begin = {0};   ///< first block of each row node, and the end
    std::vector<unsigned int> columns;       ///< first column of each block, by local number
    std::vector<Number>       values;        ///< blocks column by column, and a spare number after the last

    explicit NodeBlocks(const la::SparseMatrix &A, unsigned int height = 3, unsigned int width = 3);

    /// Takes the values anew, of a matrix with the same pattern.
    void update(const la::SparseMatrix &A);
  };
} // namespace retroforge
