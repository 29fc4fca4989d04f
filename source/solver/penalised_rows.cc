// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/solver/penalised_rows.h>

#include <deal.II/lac/solver_gmres.h>
#include <deal.II/lac/vector.h>

namespace retroforge
{
  namespace
  {
    /// Some rows and columns of a matrix.
    struct Submatrix
    {
      bool                                                      transposed = false;
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

      /// y = A x, or A^T x.
      void vmult(dealii::Vector<double> &y, const dealii::Vector<double> &x) const
      {
        y = 0.;
        for (std::size_t i = 0; i < entries.size(); ++i)
          for (const auto &[j, value] : entries[i])
            if (transposed)
              y[j] += value * x[i];
            else
              y[i] += value * x[j];
      }
    };

    /// Division by the diagonal.
    struct Diagonal
    {
      const std::vector<double> &of;

      void vmult(dealii::Vector<double> &y, const dealii::Vector<double> &x) const
      {
        for (std::size_t i = 0; i < of.size(); ++i)
          y[i] = x[i] / of[i];
      }
    };

    /// d = A^(-1) residual  of any A.
    std::vector<double> solve_unsymmetric(const Submatrix &A, const std::vector<double> &residual)
    {
      constexpr unsigned int                      most = 200;
      const dealii::Vector<double>                b(residual.begin(), residual.end());
      dealii::Vector<double>                      d(b.size());
      dealii::IterationNumberControl              control(most, 1e-10 * b.l2_norm());
      dealii::SolverGMRES<dealii::Vector<double>> gmres(control);
      gmres.solve(A, d, b, Diagonal{A.diagonal});
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
    Submatrix                        A(*system.A, rows);
    A.transposed = transposition == Transposition::transposed;
    std::vector<double> change(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
      change[i] = r[rows[i]];
    if (system.penalties_couple && !system.symmetric)
      change = solve_unsymmetric(A, change);
    else if (system.penalties_couple)
      change = solve(A, std::move(change));
    else
      for (std::size_t i = 0; i < rows.size(); ++i)
        change[i] /= A.diagonal[i];
    for (std::size_t i = 0; i < rows.size(); ++i)
      x[rows[i]] += change[i];
  }
} // namespace retroforge
