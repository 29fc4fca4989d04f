// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/optimization/least_squares.h>

#include <deal.II/lac/lapack_full_matrix.h>

#include <algorithm>

namespace retroforge
{
  std::vector<double> least_squares(const std::vector<std::vector<double>> &columns,
                                    const std::vector<double>              &right)
  {
    const std::size_t m = right.size(), n = columns.size();
    Assert(
      std::all_of(columns.begin(), columns.end(), [&](const auto &column) { return column.size() == m; }),
      dealii::ExcMessage("columns are as long as the right-hand side"));
    std::vector<double> x(n, 0.);
    if (m == 0 || n == 0)
      return x;
    dealii::LAPACKFullMatrix<double> matrix(m, n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < m; ++j)
        matrix(j, i) = columns[i][j];
    matrix.compute_svd();
    const auto      &u = matrix.get_svd_u(), &vt = matrix.get_svd_vt();
    constexpr double seen = 1e-10; // of the largest singular value
    for (std::size_t k = 0; k < std::min(m, n); ++k)
    {
      const double sigma = matrix.singular_value(k);
      if (!(sigma > seen * matrix.singular_value(0)))
        break;
      double along = 0.;
      for (std::size_t j = 0; j < m; ++j)
        along += u(j, k) * right[j];
      for (std::size_t i = 0; i < n; ++i)
        x[i] += along / sigma * vt(k, i);
    }
    return x;
  }
} // namespace retroforge
