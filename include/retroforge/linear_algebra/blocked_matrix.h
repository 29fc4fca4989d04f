// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/linear_algebra/node_blocks.h>

#include <Epetra_BasicRowMatrix.h>
#include <Epetra_MultiVector.h>

#include <memory>

namespace retroforge
{
  /// A matrix with rows and columns in threes whose products go by blocks of nodes: sums in the order of the
  /// matrix's own product, from fewer bytes. What Trilinos' preconditioners ask for besides comes from the
  /// matrix.
  class BlockedMatrix : public Epetra_BasicRowMatrix
  {
  public:
    /// @param matrix  must live as long
    explicit BlockedMatrix(const la::SparseMatrix &matrix);

    /// After the matrix has changed its values.
    void update() { blocks_.update(matrix_); }

    /// y = A x
    void vmult(la::Vector &y, const la::Vector &x) const;

    const la::SparseMatrix &matrix() const { return matrix_; }

    /// @name What Epetra_BasicRowMatrix asks for
    ///@{
    int Multiply(bool transposed, const Epetra_MultiVector &x, Epetra_MultiVector &y) const override;
    int ExtractMyRowCopy(int row, int length, int &n, double *values, int *indices) const override;
    int NumMyRowEntries(int row, int &n) const override;
    int ExtractDiagonalCopy(Epetra_Vector &diagonal) const override;
    int ExtractMyEntryView(int entry, double *&value, int &row, int &column) override;
    int ExtractMyEntryView(int entry, const double *&value, int &row, int &column) const override;
    ///@}

  private:
    const la::SparseMatrix &matrix_;
    NodeBlocks<double>      blocks_;
    /// Entries of x in the columns of A, with those of other ranks; null on one rank.
    std::unique_ptr<Epetra_MultiVector> columns_;
  };
} // namespace retroforge
