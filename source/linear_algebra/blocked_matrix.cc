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

    /// y = A x, or y += A x, of blocks of three rows, one sum after the other, as a product by rows has them.
    template <unsigned int width, bool add>
    RETROFORGE_INLINE void multiply_rows(const NodeBlocks<double> &A, const double *x, double *y)
    {
      const double       *block   = A.values.data();
      const unsigned int *columns = A.columns.data();
      for (unsigned int node = 0; node + 1 < A.begin.size(); ++node, y += 3)
      {
        Lanes sum = {};
        for (unsigned int e = A.begin[node]; e < A.begin[node + 1]; ++e)
          for (unsigned int j = 0; j < width; ++j, block += 3)
            sum += load(block) * x[columns[e] + j];
        for (unsigned int i = 0; i < 3; ++i)
          y[i] = add ? y[i] + sum[i] : sum[i];
      }
    }

    /// The same of blocks of one row: each column of a block has its own sum, so that they need not wait for
    /// each other.
    template <unsigned int width, bool add>
    RETROFORGE_INLINE void multiply_row(const NodeBlocks<double> &A, const double *x, double *y)
    {
      const double       *block   = A.values.data();
      const unsigned int *columns = A.columns.data();
      for (unsigned int node = 0; node + 1 < A.begin.size(); ++node)
      {
        double sums[width] = {};
        for (unsigned int e = A.begin[node]; e < A.begin[node + 1]; ++e)
          for (unsigned int j = 0; j < width; ++j)
            sums[j] += *block++ * x[columns[e] + j];
        double sum = sums[0];
        for (unsigned int j = 1; j < width; ++j)
          sum += sums[j];
        y[node] = add ? y[node] + sum : sum;
      }
    }

    template <bool add>
    RETROFORGE_INLINE void multiply_blocks(const NodeBlocks<double> &A, const double *x, double *y)
    {
      if (A.height == 3 && A.width == 3)
        multiply_rows<3, add>(A, x, y);
      else if (A.height == 3)
        multiply_rows<1, add>(A, x, y);
      else if (A.width == 3)
        multiply_row<3, add>(A, x, y);
      else
        multiply_row<1, add>(A, x, y);
    }

    // Not by fused multiplications: the same bits on all processors.
    RETROFORGE_ALSO_FOR("avx")
    void multiply(const NodeBlocks<double> &A, const double *x, double *y)
    {
      multiply_blocks<false>(A, x, y);
    }

    RETROFORGE_ALSO_FOR("avx")
    void multiply_add(const NodeBlocks<double> &A, const double *x, double *y)
    {
      multiply_blocks<true>(A, x, y);
    }
  } // namespace

  BlockedMatrix::BlockedMatrix(const la::SparseMatrix &matrix,
                               const unsigned int      height,
                               const unsigned int      width)
      : Epetra_BasicRowMatrix(matrix.trilinos_matrix().Comm())
      , matrix_(matrix)
      , blocks_(matrix, height, width)
  {
    Assert((height == 1 || height == 3) && (width == 1 || width == 3), dealii::ExcInternalError());
    const Epetra_CrsMatrix &A = matrix.trilinos_matrix();
    SetMaps(A.RowMap(), A.ColMap(), A.DomainMap(), A.RangeMap());
    if (A.Importer() != nullptr)
      columns_ = std::make_unique<Epetra_MultiVector>(A.ColMap(), 1, false);
  }

  void BlockedMatrix::vmult(la::Vector &y, const la::Vector &x) const
  {
    AssertDimension(x.locally_owned_size(),
                    static_cast<unsigned int>(matrix_.trilinos_matrix().DomainMap().NumMyElements()));
    AssertDimension(y.locally_owned_size(), static_cast<unsigned int>(matrix_.trilinos_matrix().NumMyRows()));
    Multiply(false, x.trilinos_vector(), y.trilinos_vector());
  }

  void BlockedMatrix::vmult_add(la::Vector &y, const la::Vector &x) const
  {
    AssertDimension(x.locally_owned_size(),
                    static_cast<unsigned int>(matrix_.trilinos_matrix().DomainMap().NumMyElements()));
    AssertDimension(y.locally_owned_size(), static_cast<unsigned int>(matrix_.trilinos_matrix().NumMyRows()));
    multiply_add(blocks_, in_columns(x.trilinos_vector(), 0), y.begin());
  }

  const double *BlockedMatrix::in_columns(const Epetra_MultiVector &x, const int vector) const
  {
    if (!columns_)
      return x[vector];
    columns_->Import(*x(vector), *matrix_.trilinos_matrix().Importer(), Insert);
    return (*columns_)[0];
  }

  int BlockedMatrix::Multiply(const bool transposed, const Epetra_MultiVector &x, Epetra_MultiVector &y) const
  {
    if (transposed)
      return matrix_.trilinos_matrix().Multiply(true, x, y);
    for (int v = 0; v < x.NumVectors(); ++v)
      multiply(blocks_, in_columns(x, v), y[v]);
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
