// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/linear_algebra/node_blocks.h>

#include <Epetra_CrsMatrix.h>

namespace retroforge
{
  template <typename Number>
  NodeBlocks<Number>::NodeBlocks(const la::SparseMatrix &A,
                                 const unsigned int      height,
                                 const unsigned int      width)
      : height(height), width(width)
  {
    int    *first, *numbers;
    double *entries;
    A.trilinos_matrix().ExtractCrsDataPointers(first, numbers, entries);
    const unsigned int n_rows = A.trilinos_matrix().NumMyRows(), size = height * width;
    Assert(n_rows % height == 0 && A.trilinos_matrix().NumMyNonzeros() % size == 0,
           dealii::ExcMessage("rows and columns come by nodes"));
    begin.reserve(n_rows / height + 1);
    columns.reserve(A.trilinos_matrix().NumMyNonzeros() / size);
    for (unsigned int row = 0; row < n_rows; row += height)
    {
      for (int e = first[row]; e < first[row + 1]; e += width)
        columns.push_back(numbers[e]);
      begin.push_back(columns.size());
    }
    values.assign(size * columns.size() + 1, 0.);
    update(A);
  }

  template <typename Number>
  void NodeBlocks<Number>::update(const la::SparseMatrix &A)
  {
    int    *first, *numbers;
    double *entries;
    A.trilinos_matrix().ExtractCrsDataPointers(first, numbers, entries);
    Number *block = values.data();
    for (unsigned int node = 0; node + 1 < begin.size(); ++node)
    {
      const double *rows[3];
      for (unsigned int i = 0; i < height; ++i)
        rows[i] = entries + first[height * node + i];
      for (unsigned int e = begin[node]; e < begin[node + 1]; ++e)
        for (unsigned int j = 0; j < width; ++j)
          for (unsigned int i = 0; i < height; ++i)
            *block++ = *rows[i]++;
    }
  }

  template struct NodeBlocks<double>;
  template struct NodeBlocks<float>;
} // namespace retroforge
