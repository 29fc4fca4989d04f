// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/linear_algebra/node_blocks.h>

#include <Epetra_CrsMatrix.h>

namespace retroforge
{
  template <typename Number>
  NodeBlocks<Number>::NodeBlocks(const la::SparseMatrix &A)
  {
    int    *first, *numbers;
    double *entries;
    A.trilinos_matrix().ExtractCrsDataPointers(first, numbers, entries);
    const int n_rows = A.trilinos_matrix().NumMyRows();
    Assert(n_rows % 3 == 0 && A.trilinos_matrix().NumMyNonzeros() % 9 == 0,
           dealii::ExcMessage("rows and columns come in threes"));
    begin.reserve(n_rows / 3 + 1);
    columns.reserve(A.trilinos_matrix().NumMyNonzeros() / 9);
    for (int row = 0; row < n_rows; row += 3)
    {
      for (int e = first[row]; e < first[row + 1]; e += 3)
        columns.push_back(numbers[e]);
      begin.push_back(columns.size());
    }
    values.assign(9 * columns.size() + 1, 0.);
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
      for (unsigned int i = 0; i < 3; ++i)
        rows[i] = entries + first[3 * node + i];
      for (unsigned int e = begin[node]; e < begin[node + 1]; ++e, block += 9)
        for (unsigned int i = 0; i < 3; ++i, rows[i - 1] += 3)
          for (unsigned int j = 0; j < 3; ++j)
            block[3 * j + i] = rows[i][j];
    }
  }

  template struct NodeBlocks<double>;
  template struct NodeBlocks<float>;
} // namespace retroforge
