// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/processors.h>
#include <retroforge/linear_algebra/blocked_matrix.h>

#include <Epetra_CrsMatrix.h>
#include <Epetra_Import.h>
#include <Epetra_Vector.h>

#include <cstring>

namespace retroforge
{
  namespace
  {
    /// Three numbers and one that does not count.
    typedef double Lanes __attribute__((vector_size(32)));

    RETROFORGE_INLINE Lanes load(const double *x)
    {
      Lanes lanes;
      std::memcpy(&lanes, x, sizeof lanes);
      return lanes;
    }

    /// One sum after the other, as a product by rows has them, and not by fused multiplications: the same
    /// bits on all processors.
    RETROFORGE_ALSO_FOR("avx")
    void multiply(const NodeBlocks<double> &A, const double *x, double *y)
    {
      const double       *block   = A.values.data();
      const unsigned int *columns = A.columns.data();
      for (unsigned int node = 0; node + 1 < A.begin.size(); ++node, y += 3)
      {
        Lanes sum = {};
        for (unsigned int e = A.begin[node]; e < A.begin[node + 1]; ++e, block += 9)
        {
          const double *of_node = x + columns[e];
          sum += load(block) * of_node[0];
          sum += load(block + 3) * of_node[1];
          sum += load(block + 6) * of_node[2];
        }
        std::memcpy(y, &sum, 3 * sizeof(double));
      }
    }
  } // namespace

  BlockedMatrix::BlockedMatrix(const la::SparseMatrix &matrix)
      : Epetra_BasicRowMatrix(matrix.trilinos_matrix().Comm()), matrix_(matrix), blocks_(matrix)
  {
    const Epetra_CrsMatrix &A = matrix.trilinos_matrix();
    SetMaps(A.RowMap(), A.ColMap(), A.DomainMap(), A.RangeMap());
    if (A.Importer() != nullptr)
      columns_ = std::make_unique<Epetra_MultiVector>(A.ColMap(), 1, false);
  }

  void BlockedMatrix::vmult(la::Vector &y, const la::Vector &x) const
  {
    AssertDimension(x.locally_owned_size(), static_cast<unsigned int>(matrix_.trilinos_matrix().NumMyRows()));
    AssertDimension(y.locally_owned_size(), x.locally_owned_size());
    Multiply(false, x.trilinos_vector(), y.trilinos_vector());
  }

  int BlockedMatrix::Multiply(const bool transposed, const Epetra_MultiVector &x, Epetra_MultiVector &y) const
  {
    const Epetra_CrsMatrix &A = matrix_.trilinos_matrix();
    if (transposed)
      return A.Multiply(true, x, y);
    for (int v = 0; v < x.NumVectors(); ++v)
    {
      if (columns_)
        columns_->Import(*x(v), *A.Importer(), Insert);
      multiply(blocks_, columns_ ? (*columns_)[0] : x[v], y[v]);
    }
    return 0;
  }

  int BlockedMatrix::ExtractMyRowCopy(const int row,
                                      const int length,
                                      int      &n,
                                      double   *values,
                                      int      *indices) const
  {
    return matrix_.trilinos_matrix().ExtractMyRowCopy(row, length, n, values, indices);
  }

  int BlockedMatrix::NumMyRowEntries(const int row, int &n) const
  {
    return matrix_.trilinos_matrix().NumMyRowEntries(row, n);
  }

  int BlockedMatrix::ExtractDiagonalCopy(Epetra_Vector &diagonal) const
  {
    return matrix_.trilinos_matrix().ExtractDiagonalCopy(diagonal);
  }

  // Single entries are what the base class makes rows, norms and counts of, where a class leaves them to it.
  // ML asks for rows alone.
  int BlockedMatrix::ExtractMyEntryView(int, double *&, int &, int &)
  {
    return -1;
  }

  int BlockedMatrix::ExtractMyEntryView(int, const double *&, int &, int &) const
  {
    return -1;
  }
} // namespace retroforge
