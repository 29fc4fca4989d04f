// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/linear_algebra/node_matrix.h>

#include <Epetra_CrsGraph.h>
#include <Epetra_CrsMatrix.h>
#include <Epetra_Map.h>
#include <Epetra_MpiComm.h>

#include <algorithm>
#include <set>

namespace retroforge
{
  NodePattern::NodePattern(const NodeRange          &rows,
                           const NodeRange          &columns,
                           const Rows<unsigned int> &neighbours)
      : rows_(rows), columns_(columns)
  {
    AssertDimension(neighbours.size(), rows.n_owned());
    for (unsigned int a = columns.begin; a < columns.end; ++a)
      column_nodes_.push_back(a);
    std::set<unsigned int> others;
    for (unsigned int a = rows.begin; a < rows.end; ++a)
      for (const unsigned int b : neighbours[a - rows.begin])
        if (!columns.owns(b))
          others.insert(b);
    column_nodes_.insert(column_nodes_.end(), others.begin(), others.end());
    of_row_.begin.reserve(neighbours.begin.size());
    of_row_.entries.reserve(neighbours.entries.size());
    for (unsigned int a = rows.begin; a < rows.end; ++a)
    {
      for (const unsigned int b : neighbours[a - rows.begin])
        of_row_.entries.push_back(local_number(b));
      std::sort(of_row_.entries.begin() + of_row_.begin.back(), of_row_.entries.end());
      of_row_.begin.push_back(of_row_.entries.size());
    }
  }

  unsigned int NodePattern::local_number(const unsigned int column) const
  {
    if (columns_.owns(column))
      return column - columns_.begin;
    const auto others = column_nodes_.begin() + columns_.n_owned();
    return std::lower_bound(others, column_nodes_.end(), column) - column_nodes_.begin();
  }

  unsigned int NodePattern::position(const unsigned int local_row, const unsigned int column) const
  {
    const auto         row    = of_row_[local_row];
    const unsigned int number = local_number(column);
    const auto         at     = std::lower_bound(row.begin(), row.end(), number);
    AssertThrow(at != row.end() && *at == number && number < column_nodes_.size() &&
                  column_nodes_[number] == column,
                dealii::ExcMessage("Two nodes share no entry of the matrix."));
    return at - row.begin();
  }

  namespace
  {
    /// Returns the map of the degrees of freedom of nodes in the order given. Left to itself, Trilinos orders
    /// the columns of each matrix that another rank owns in its own way.
    Epetra_Map map_of(const std::vector<unsigned int> &nodes,
                      const unsigned int               n_nodes,
                      const unsigned int               width,
                      const Epetra_Comm               &comm)
    {
      std::vector<int> ids;
      for (unsigned int l = 0; l < n_nodes; ++l)
        for (unsigned int i = 0; i < width; ++i)
          ids.push_back(width * nodes[l] + i);
      return {-1, static_cast<int>(ids.size()), ids.data(), 0, comm};
    }

    Epetra_Map map_of_owned(const NodeRange &range, const unsigned int width, const Epetra_Comm &comm)
    {
      return {-1, static_cast<int>(width * range.n_owned()), 0, comm};
    }
  } // namespace

  NodeMatrix::NodeMatrix(la::SparseMatrix                  &matrix,
                         std::shared_ptr<const NodePattern> pattern,
                         const unsigned int                 rows,
                         const unsigned int                 columns,
                         MPI_Comm                           comm)
      : pattern_(std::move(pattern)), rows_(rows), columns_(columns)
  {
    const Epetra_MpiComm epetra_comm(comm);
    const unsigned int   n_owned    = pattern_->rows().n_owned();
    const Epetra_Map     row_map    = map_of_owned(pattern_->rows(), rows, epetra_comm);
    const Epetra_Map     domain_map = map_of_owned(pattern_->columns(), columns, epetra_comm);
    const auto          &nodes      = pattern_->column_nodes();
    const Epetra_Map     column_map = map_of(nodes, nodes.size(), columns, epetra_comm);
    std::vector<int>     lengths;
    for (unsigned int a = 0; a < n_owned; ++a)
      lengths.insert(lengths.end(), rows, columns * pattern_->row(a).size());
    Epetra_CrsGraph  graph(Copy, row_map, column_map, lengths.data(), true);
    std::vector<int> entries;
    for (unsigned int a = 0; a < n_owned; ++a)
    {
      entries.clear();
      for (const unsigned int b : pattern_->row(a))
        for (unsigned int j = 0; j < columns; ++j)
          entries.push_back(columns * b + j);
      for (unsigned int i = 0; i < rows; ++i)
        graph.InsertMyIndices(rows * a + i, entries.size(), entries.data());
    }
    graph.FillComplete(domain_map, row_map);
    graph.OptimizeStorage();
    Epetra_CrsMatrix values(Copy, graph);
    values.FillComplete(domain_map, row_map);
    matrix.reinit(values, false);
    int *begin, *indices;
    const_cast<Epetra_CrsMatrix &>(matrix.trilinos_matrix()).ExtractCrsDataPointers(begin, indices, values_);
    begin_          = begin;
    column_indices_ = indices;
  }
} // namespace retroforge
