// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Matrices of blocks that belong to pairs of nodes. Row nodes 0 … 23 are points of a ring, each meets itself,
// its neighbours and a node across; column nodes are those, or every second of them. Proved, on one rank and
// on two:
// - every entry written by its node and place is found by deal.II under its global row and column;
// - columns another rank owns follow the owned ones, ascending;
// - rows and columns scaled are those that deal.II's product sees scaled;
// - nodes that do not meet have no place.

#include <deal.II/base/mpi.h>

#include <retroforge/linear_algebra/node_matrix.h>

#include <algorithm>
#include <iostream>

using namespace retroforge;
using namespace dealii::Utilities::MPI;

namespace
{
  constexpr unsigned int n = 24;

  NodeRange range_of(const unsigned int all)
  {
    const unsigned int rank = this_mpi_process(MPI_COMM_WORLD), ranks = n_mpi_processes(MPI_COMM_WORLD);
    return {all * rank / ranks, all * (rank + 1) / ranks, all};
  }

  /// @param coarsening  how many row nodes there are to a column node
  Rows<unsigned int> neighbours(const NodeRange &range, const unsigned int coarsening)
  {
    Rows<unsigned int> rows;
    for (unsigned int a = range.begin; a < range.end; ++a)
    {
      std::vector<unsigned int> met;
      for (const unsigned int b : {a, a + 1, a + n - 1, a + n / 2})
        met.push_back(b % n / coarsening);
      // In an order that is not ascending, each once.
      std::sort(met.begin(), met.end(), std::greater<>());
      met.erase(std::unique(met.begin(), met.end()), met.end());
      rows.entries.insert(rows.entries.end(), met.begin(), met.end());
      rows.begin.push_back(rows.entries.size());
    }
    return rows;
  }

  double value(const unsigned int row, const unsigned int column)
  {
    return 1. + row + 0.01 * column;
  }

  const char *all_ranks(const bool good)
  {
    return min(good ? 1 : 0, MPI_COMM_WORLD) == 1 ? "yes" : "NO";
  }

  void check(const unsigned int coarsening, const unsigned int rows, const unsigned int columns)
  {
    const NodeRange          row_nodes = range_of(n), column_nodes = range_of(n / coarsening);
    const Rows<unsigned int> meets   = neighbours(row_nodes, coarsening);
    const auto               pattern = std::make_shared<const NodePattern>(row_nodes, column_nodes, meets);
    la::SparseMatrix         matrix;
    const NodeMatrix         view(matrix, pattern, rows, columns, MPI_COMM_WORLD);
    for (unsigned int a = row_nodes.begin; a < row_nodes.end; ++a)
      for (const unsigned int b : meets[a - row_nodes.begin])
        for (unsigned int i = 0; i < rows; ++i)
          for (unsigned int j = 0; j < columns; ++j)
            view.entry(a - row_nodes.begin, i, pattern->position(a - row_nodes.begin, b))[j] =
              value(rows * a + i, columns * b + j);
    bool found = true;
    for (unsigned int a = row_nodes.begin; a < row_nodes.end; ++a)
      for (unsigned int i = 0; i < rows; ++i)
      {
        found = found && matrix.row_length(rows * a + i) == columns * meets[a - row_nodes.begin].size();
        for (const unsigned int b : meets[a - row_nodes.begin])
          for (unsigned int j = 0; j < columns; ++j)
            found = found && matrix.el(rows * a + i, columns * b + j) == value(rows * a + i, columns * b + j);
      }
    const auto &seen    = pattern->column_nodes();
    const auto  others  = seen.begin() + column_nodes.n_owned();
    const bool  ordered = std::is_sorted(seen.begin(), others) && std::is_sorted(others, seen.end()) &&
                         (n_mpi_processes(MPI_COMM_WORLD) == 1) == (others == seen.end());
    bool refused = false;
    try
    {
      pattern->position(0, (row_nodes.begin + 5) / coarsening);
    }
    catch (const dealii::ExceptionBase &)
    {
      refused = true;
    }
    std::cout << rows << " x " << columns << " to a pair of nodes, " << coarsening
              << " rows' to a column's: entries " << all_ranks(found) << ", order " << all_ranks(ordered)
              << ", refused " << all_ranks(refused) << "\n";
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (this_mpi_process(MPI_COMM_WORLD) > 0)
    std::cout.setstate(std::ios::failbit);
  check(1, 3, 3);
  check(1, 1, 3);
  check(2, 3, 1);
}
