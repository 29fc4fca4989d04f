// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/node_range.h>
#include <retroforge/core/rows.h>
#include <retroforge/linear_algebra/types.h>

#include <memory>

namespace retroforge
{
  /// The nodes of one space that the owned nodes of another meet in the rows of a matrix.
  class NodePattern
  {
  public:
    /// @param neighbours  the column nodes of each owned row node, in any order
    NodePattern(const NodeRange &rows, const NodeRange &columns, const Rows<unsigned int> &neighbours);

    const NodeRange &rows() const { return rows_; }
    const NodeRange &columns() const { return columns_; }
    /// Columns have local numbers: owned ones, then the others that are met, both ascending.
    const std::vector<unsigned int> &column_nodes() const { return column_nodes_; }
    /// The columns that row node `local` (counted from rows().begin) meets, by local number, ascending.
    dealii::ArrayView<const unsigned int> row(const unsigned int local) const { return of_row_[local]; }
    /// Returns the position of a column node, by its global number, in the list of a row.
    /// @throws dealii::ExcMessage where the two do not meet
    unsigned int position(unsigned int local_row, unsigned int column) const;

  private:
    unsigned int local_number(unsigned int column) const;

    NodeRange                 rows_, columns_;
    std::vector<unsigned int> column_nodes_;
    Rows<unsigned int>        of_row_;
  };

  /// The entries of a matrix whose nodes have several degrees of freedom each, in place: all r-th rows of a
  /// node have its columns in the order of the pattern, the degrees of freedom of a column node one after the
  /// other.
  class NodeMatrix
  {
  public:
    /// @param matrix         gets the pattern, with zeros; must live as long
    /// @param rows, columns  degrees of freedom of a row node, and of a column node
    NodeMatrix(la::SparseMatrix                  &matrix,
               std::shared_ptr<const NodePattern> pattern,
               unsigned int                       rows,
               unsigned int                       columns,
               MPI_Comm                           comm);

    /// One row: n entries, each with the local number of its degree of freedom.
    struct Row
    {
      const int   *columns;
      double      *values;
      unsigned int n;
    };

    const NodePattern &pattern() const { return *pattern_; }
    unsigned int       n_rows() const { return rows_ * pattern_->rows().n_owned(); }
    unsigned int       n_columns() const { return columns_ * pattern_->column_nodes().size(); }

    Row row(const unsigned int i) const
    {
      AssertIndexRange(i, n_rows());
      return {column_indices_ + begin_[i],
              values_ + begin_[i],
              static_cast<unsigned int>(begin_[i + 1] - begin_[i])};
    }

    /// The entries of column node `position` in the r-th row of a row node.
    double *entry(const unsigned int local_node, const unsigned int r, const unsigned int position) const
    {
      AssertIndexRange(r, rows_);
      AssertIndexRange(position, pattern_->row(local_node).size());
      return values_ + begin_[rows_ * local_node + r] + columns_ * position;
    }

    /// Global number of a local degree of freedom of the columns.
    unsigned int column(const unsigned int local) const
    {
      AssertIndexRange(local, n_columns());
      return columns_ * pattern_->column_nodes()[local / columns_] + local % columns_;
    }

    void clear() const { std::fill(values_, values_ + begin_[n_rows()], 0.); }

  private:
    std::shared_ptr<const NodePattern> pattern_;
    unsigned int                       rows_, columns_;
    const int                         *begin_, *column_indices_;
    double                            *values_;
  };
} // namespace retroforge
