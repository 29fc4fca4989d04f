// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/solver/penalised_rows.h>

#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>

namespace retroforge
{
  namespace
  {
    /// @param i  local row; a column that is owned has the local number of its row
    double diagonal_entry(const NodeMatrix &matrix, const unsigned int i)
    {
      const NodeMatrix::Row row = matrix.row(i);
      return row.values[std::find(row.columns, row.columns + row.n, static_cast<int>(i)) - row.columns];
    }

    /// Some rows and columns of a matrix.
    struct Submatrix
    {
      std::vector<double>                                       diagonal;
      std::vector<std::vector<std::pair<unsigned int, double>>> entries;

      /// @param rows  local rows; a column that is owned has the local number of its row
      Submatrix(const NodeMatrix &matrix, const std::vector<unsigned int> &rows)
          : diagonal(rows.size(), 0.), entries(rows.size())
      {
        std::vector<unsigned int> number(matrix.n_columns(), invalid_index);
        for (std::size_t i = 0; i < rows.size(); ++i)
          number[rows[i]] = i;
        for (std::size_t i = 0; i < rows.size(); ++i)
        {
          const NodeMatrix::Row row = matrix.row(rows[i]);
          for (unsigned int e = 0; e < row.n; ++e)
            if (const unsigned int j = number[row.columns[e]]; j != invalid_index)
            {
              entries[i].emplace_back(j, row.values[e]);
              if (j == i)
                diagonal[i] = row.values[e];
            }
        }
      }
    };

    /// d = A^(-1) residual, or A^(-T) residual, of any A by its factors; zero where A is singular, which the
    /// solver of the whole system has to judge, with all ranks.
    std::vector<double> solve_unsymmetric(const Submatrix           &A,
                                          const Transposition        transposition,
                                          const std::vector<double> &residual)
    {
      const std::size_t              n = residual.size();
      dealii::DynamicSparsityPattern met(n, n);
      for (std::size_t i = 0; i < n; ++i)
        for (const auto &[j, value] : A.entries[i])
          met.add(i, j);
      dealii::SparsityPattern pattern;
      pattern.copy_from(met);
      dealii::SparseMatrix<double> matrix(pattern);
      for (std::size_t i = 0; i < n; ++i)
        for (const auto &[j, value] : A.entries[i])
          matrix.set(i, j, value);
      dealii::Vector<double> d(residual.begin(), residual.end());
      try
      {
        dealii::SparseDirectUMFPACK().solve(matrix, d, transposition == Transposition::transposed);
      }
      catch (const dealii::SparseDirectUMFPACK::ExcUMFPACKError &)
      {
        d = 0.;
      }
      return {d.begin(), d.end()};
    }

    /// d = A^(-1) residual  of a symmetric A.
    std::vector<double> solve(const Submatrix &A, std::vector<double> residual)
    {
      const std::size_t   n = residual.size();
      std::vector<double> d, z(n), direction, image(n);
      d.assign(n, 0.);
      const auto precondition = [&]() {
        double product = 0.;
        for (std::size_t i = 0; i < n; ++i)
        {
          z[i] = residual[i] / A.diagonal[i];
          product += residual[i] * z[i];
        }
        return product;
      };
      constexpr unsigned int most  = 200;
      double                 rz    = precondition();
      const double           first = rz;
      direction                    = z;
      for (unsigned int step = 0; step < most && rz > 1e-20 * first; ++step)
      {
        double curvature = 0.;
        for (std::size_t i = 0; i < n; ++i)
        {
          image[i] = 0.;
          for (const auto &[j, value] : A.entries[i])
            image[i] += value * direction[j];
          curvature += image[i] * direction[i];
        }
        const double length = rz / curvature;
        for (std::size_t i = 0; i < n; ++i)
        {
          d[i] += length * direction[i];
          residual[i] -= length * image[i];
        }
        const double next = precondition();
        for (std::size_t i = 0; i < n; ++i)
          direction[i] = z[i] + next / rz * direction[i];
        rz = next;
      }
      return d;
    }
  } // namespace

  void solve_penalised_rows(const SaddleSystem &system,
                            const Transposition transposition,
                            const double       *r,
                            double             *x)
  {
    const std::vector<unsigned int> &rows = system.penalised;
    if (rows.empty())
      return;
    if (!system.penalties_couple)
    {
      for (const unsigned int i : rows)
        x[i] += r[i] / diagonal_entry(*system.A, i);
      return;
    }
    const Submatrix     A(*system.A, rows);
    std::vector<double> change(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
      change[i] = r[rows[i]];
    change = system.symmetric ? solve(A, std::move(change)) : solve_unsymmetric(A, transposition, change);
    for (std::size_t i = 0; i < rows.size(); ++i)
      x[rows[i]] += change[i];
  }
} // namespace retroforge
