// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/lac/diagonal_matrix.h>
#include <deal.II/lac/vector.h>

#include <retroforge/heat/conduction_network.h>

namespace retroforge
{
  /// The symmetric matrix  diag(D) + L,  (L x)_i = sum_j g_ij (x_i - x_j),  of a network. Each rank has all of it.
  class NetworkMatrix
  {
  public:
    /// @param diagonal   D of each node, > 0
    /// @param couplings  g of each edge
    NetworkMatrix(const NetworkEdges &edges, std::vector<double> diagonal, std::vector<double> couplings);

    /// y = A x, for deal.II's solvers.
    void vmult(dealii::Vector<double> &y, const dealii::Vector<double> &x) const;

    /// Solves  A x = b  by conjugate gradients, to rounding.
    std::vector<double> solve(const std::vector<double> &b, const std::vector<double> &start) const;

  private:
    const NetworkEdges                            &edges_;
    std::vector<double>                            D_, g_;
    dealii::DiagonalMatrix<dealii::Vector<double>> preconditioner_;
  };
} // namespace retroforge
