// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Products by blocks of nodes. The nodes 0 … 23 are points of a ring, each meets itself, its neighbours and a
// node across, three unknowns each or one. Proved, on one rank and on two, against the matrix that was copied:
// - products of blocks of three rows have the same bits, those of one row agree to 1e-15 of the largest entry,
//   added to a vector or not, and so do transposed ones;
// - values that change are seen once they are taken, not before;
// - of several vectors each has its own product;
// - rows, diagonal and counts, which preconditioners ask for, are those of the matrix.

#include <deal.II/base/mpi.h>

#include "ring.h"
#include <retroforge/linear_algebra/blocked_matrix.h>

#include <Epetra_CrsMatrix.h>
#include <Epetra_Vector.h>

#include <algorithm>
#include <iostream>

using namespace retroforge;
using namespace dealii::Utilities::MPI;

namespace
{
  constexpr unsigned int n = 24;

  void fill(const NodeMatrix &view, const unsigned int seed)
  {
    for (unsigned int i = 0; i < view.n_rows(); ++i)
      for (unsigned int e = 0; e < view.row(i).n; ++e)
        view.row(i).values[e] = std::sin(1. + 3.1 * i + 0.7 * e + seed);
  }

  void say(const char *what, const bool good)
  {
    std::cout << what << ": " << (min(good ? 1 : 0, MPI_COMM_WORLD) == 1 ? "yes" : "NO") << "\n";
  }

  bool same_bits(const la::Vector &x, const la::Vector &y)
  {
    return std::equal(x.begin(), x.end(), y.begin());
  }

  bool agree(const Epetra_MultiVector &x, const Epetra_MultiVector &y)
  {
    double difference = 0., size = 0.;
    for (int v = 0; v < x.NumVectors(); ++v)
      for (int i = 0; i < x.MyLength(); ++i)
      {
        difference = std::max(difference, std::abs(x[v][i] - y[v][i]));
        size       = std::max(size, std::abs(x[v][i]));
      }
    return difference <= 1e-15 * size;
  }

  bool same_rows(const Epetra_CrsMatrix &A, const BlockedMatrix &blocked)
  {
    bool      same = A.NumMyRows() == blocked.NumMyRows() && A.MaxNumEntries() == blocked.MaxNumEntries();
    const int n_entries            = A.MaxNumEntries();
    std::vector<double> values[2]  = {std::vector<double>(n_entries), std::vector<double>(n_entries)};
    std::vector<int>    columns[2] = {std::vector<int>(n_entries), std::vector<int>(n_entries)};
    for (int row = 0; row < A.NumMyRows(); ++row)
    {
      int of_matrix, of_blocked;
      A.ExtractMyRowCopy(row, n_entries, of_matrix, values[0].data(), columns[0].data());
      blocked.ExtractMyRowCopy(row, n_entries, of_blocked, values[1].data(), columns[1].data());
      same = same && of_matrix == of_blocked && values[0] == values[1] && columns[0] == columns[1];
    }
    Epetra_Vector diagonals[2] = {Epetra_Vector(A.RowMap()), Epetra_Vector(A.RowMap())};
    A.ExtractDiagonalCopy(diagonals[0]);
    blocked.ExtractDiagonalCopy(diagonals[1]);
    return same && agree(diagonals[0], diagonals[1]);
  }

  la::Vector numbers(const NodeRange &nodes, const unsigned int width)
  {
    la::Vector x(nodes.dofs(width), MPI_COMM_WORLD);
    for (unsigned int i = 0; i < x.locally_owned_size(); ++i)
      x.begin()[i] = std::cos(2. + 0.9 * (width * nodes.begin + i));
    return x;
  }

  void multiply_blocks(const NodeRange &nodes, const unsigned int height, const unsigned int width)
  {
    la::SparseMatrix matrix;
    fill(NodeMatrix(matrix,
                    std::make_shared<const NodePattern>(nodes, nodes, ring_neighbours(nodes, n)),
                    height,
                    width,
                    MPI_COMM_WORLD),
         3);
    const BlockedMatrix blocked(matrix, height, width);
    const la::Vector    x = numbers(nodes, width);
    la::Vector          y = numbers(nodes, height), expected(y);
    matrix.vmult_add(expected, x);
    blocked.vmult_add(y, x);
    bool good = height == 3 ? same_bits(expected, y) : agree(expected.trilinos_vector(), y.trilinos_vector());
    matrix.vmult(expected, x);
    blocked.vmult(y, x);
    good &= height == 3 ? same_bits(expected, y) : agree(expected.trilinos_vector(), y.trilinos_vector());
    say(("blocks of " + std::to_string(height) + " x " + std::to_string(width)).c_str(), good);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const unsigned int rank = this_mpi_process(MPI_COMM_WORLD), ranks = n_mpi_processes(MPI_COMM_WORLD);
  if (rank > 0)
    std::cout.setstate(std::ios::failbit);
  const NodeRange  nodes{n * rank / ranks, n * (rank + 1) / ranks, n};
  la::SparseMatrix matrix;
  const NodeMatrix view(matrix,
                        std::make_shared<const NodePattern>(nodes, nodes, ring_neighbours(nodes, n)),
                        3,
                        3,
                        MPI_COMM_WORLD);
  fill(view, 1);
  BlockedMatrix           blocked(matrix);
  const Epetra_CrsMatrix &A = matrix.trilinos_matrix();

  const la::Vector x = numbers(nodes, 3);
  la::Vector       expected(x), y(x);
  matrix.vmult(expected, x);
  blocked.vmult(y, x);
  say("product", agree(expected.trilinos_vector(), y.trilinos_vector()));
  matrix.Tvmult(expected, x);
  blocked.Multiply(true, x.trilinos_vector(), y.trilinos_vector());
  say("transposed product", agree(expected.trilinos_vector(), y.trilinos_vector()));

  fill(view, 2);
  matrix.vmult(expected, x);
  blocked.vmult(y, x);
  const bool before = agree(expected.trilinos_vector(), y.trilinos_vector());
  blocked.update();
  blocked.vmult(y, x);
  say("new values", !before && agree(expected.trilinos_vector(), y.trilinos_vector()));

  Epetra_MultiVector two(A.DomainMap(), 2), of_matrix(A.RangeMap(), 2), of_blocked(A.RangeMap(), 2);
  for (int i = 0; i < two.MyLength(); ++i)
  {
    two[0][i] = x.begin()[i];
    two[1][i] = x.begin()[i] * x.begin()[i];
  }
  A.Multiply(false, two, of_matrix);
  blocked.Multiply(false, two, of_blocked);
  say("two vectors", agree(of_matrix, of_blocked));
  say("rows, diagonal, counts",
      same_rows(A, blocked) && A.NumGlobalNonzeros() == blocked.NumGlobalNonzeros() &&
        A.NumMyNonzeros() == blocked.NumMyNonzeros());

  for (const unsigned int height : {3, 1})
    for (const unsigned int width : {3, 1})
      multiply_blocks(nodes, height, width);
}
