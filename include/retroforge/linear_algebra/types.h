// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/lac/trilinos_block_sparse_matrix.h>
#include <deal.II/lac/trilinos_parallel_block_vector.h>

/// @file
/// Distributed vectors and matrices by the names that the rest of the program knows them by. Whose they are,
/// and which Trilinos package stores them, is known in linear_algebra/ alone.
namespace retroforge::la
{
  using Vector            = dealii::TrilinosWrappers::MPI::Vector;
  using BlockVector       = dealii::TrilinosWrappers::MPI::BlockVector;
  using SparseMatrix      = dealii::TrilinosWrappers::SparseMatrix;
  using BlockSparseMatrix = dealii::TrilinosWrappers::BlockSparseMatrix;
} // namespace retroforge::la

namespace retroforge
{
  /// Selects one of the two systems of a matrix M: M x = b, or M^T x = b.
  enum class Transposition
  {
    plain,
    transposed
  };
} // namespace retroforge
