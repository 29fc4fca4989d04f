// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/linear_algebra/node_blocks.h>

#include <Epetra_BasicRowMatrix.h>
#include <Epetra_MultiVector.h>

#include <memory>

namespace retroforge
{
  /// A matrix with rows and columns by nodes, of velocities or of pressures, whose products go by blocks of two
  /// nodes: from fewer bytes than those of the matrix, with sums in the same order but for rows of a pressure
  /// and columns of velocities, which have a sum for each direction. What Trilinos' preconditioners ask for
  /// besides comes from the matrix.
  class BlockedMatrix : public Epetra_BasicRowMatrix
  {
  public:
    /// @param matrix  must live as long
    /// @param height  rows of a node, 3 or 1
    /// @param width   columns of a node, 3 or 1
    explicit BlockedMatrix(const la::SparseMatrix &matrix, unsigned int height = 3, unsigned int width = 3);

    /// After the matrix has changed its values.
    void update() { blocks_.update(matrix_); }

    /// y = A x
    void vmult(la::Vector &y, const la::Vector &x) const;
    /// y += A x
    void vmult_add(la::Vector &y, const la::Vector &x) const;

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
    /// The entries of x in the columns of A, with those of other ranks.
    const double *in_columns(const Epetra_MultiVector &x, int vector) const;

    const la::SparseMatrix &matrix_;
    NodeBlocks<double>      blocks_;
    /// Entries of x in the columns of A, with those of other ranks; null on one rank.
    std::unique_ptr<Epetra_MultiVector> columns_;
  };
} // namespace retroforge
