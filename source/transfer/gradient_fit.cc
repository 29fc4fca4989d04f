// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/transfer/gradient_fit.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace retroforge
{
  namespace
  {
    constexpr unsigned int max_unknowns = 19;

    // eps_2 and eps_3 over the largest entry of the normal matrix.
    constexpr double damping_of_second = 1e-6, damping_of_third = 1e-4;
    // Points on a plane or line do not determine the gradient across it; relative like eps.
    constexpr double least_pivot = 1e-13;

    using Monomials = std::array<double, max_unknowns>;
    using Matrix    = std::array<Monomials, max_unknowns>;

    constexpr unsigned int n_second(const unsigned int n)
    {
      return n * (n + 1) / 2;
    }

    constexpr unsigned int n_third(const unsigned int n)
    {
      return n * (n + 1) * (n + 2) / 6;
    }

    // The products of three components of d, those of two, then its n components.
    Monomials monomials(const Vec3 &d, const unsigned int n)
    {
      Monomials    m = {};
      unsigned int k = 0;
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = i; j < n; ++j)
          for (unsigned int l = j; l < n; ++l)
            m[k++] = d[i] * d[j] * d[l];
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = i; j < n; ++j)
          m[k++] = d[i] * d[j];
      for (unsigned int i = 0; i < n; ++i)
        m[k++] = d[i];
      return m;
    }

    // Cholesky's factor in place of the lower triangle; false when a pivot is lost.
    bool factorise(Matrix &A, const unsigned int size, const double least)
    {
      for (unsigned int j = 0; j < size; ++j)
        for (unsigned int i = j; i < size; ++i)
        {
          for (unsigned int k = 0; k < j; ++k)
            A[i][j] -= A[i][k] * A[j][k];
          if (i > j)
            A[i][j] /= A[j][j];
          else if (A[j][j] > least)
            A[j][j] = std::sqrt(A[j][j]);
          else
            return false;
        }
      return true;
    }

    Monomials solve(const Matrix &L, const unsigned int size, Monomials x)
    {
      for (unsigned int i = 0; i < size; ++i)
      {
        for (unsigned int k = 0; k < i; ++k)
          x[i] -= L[i][k] * x[k];
        x[i] /= L[i][i];
      }
      for (unsigned int i = size; i-- > 0;)
      {
        for (unsigned int k = i + 1; k < size; ++k)
          x[i] -= L[k][i] * x[k];
        x[i] /= L[i][i];
      }
      return x;
    }
  } // namespace

  std::optional<std::vector<double>>
  fitted_derivative(const std::vector<Vec3> &points, const unsigned int n, const Vec3 &direction)
  {
    const unsigned int first = n_third(n) + n_second(n), size = first + n;
    double             longest = 0.;
    for (const Vec3 &d : points)
      longest = std::max(longest, d.norm());
    if (longest == 0.)
      return {};
    Matrix                 A = {};
    std::vector<Monomials> rows, weighted;
    for (const Vec3 &d : points)
    {
      rows.push_back(monomials(d / longest, n));
      weighted.push_back(rows.back());
      const double relative = std::max(d.norm_square() / (longest * longest), 1e-6),
                   weight   = 1. / (relative * relative);
      for (double &entry : weighted.back())
        entry *= weight;
      for (unsigned int i = 0; i < size; ++i)
        for (unsigned int j = 0; j <= i; ++j)
          A[i][j] += weighted.back()[i] * rows.back()[j];
    }
    double largest = 0.;
    for (unsigned int i = 0; i < size; ++i)
      largest = std::max(largest, A[i][i]);
    for (unsigned int i = 0; i < first; ++i)
      A[i][i] += (i < n_third(n) ? damping_of_third : damping_of_second) * largest;
    if (!factorise(A, size, least_pivot * largest))
      return {};
    std::vector<double> coefficients(points.size(), 0.);
    // Again and again: that removes the rounding of the times before from linear fields.
    for (unsigned int pass = 0; pass < 3; ++pass)
    {
      Monomials rest = {};
      for (unsigned int i = 0; i < n; ++i)
        rest[first + i] = direction[i] / longest;
      for (std::size_t b = 0; b < points.size(); ++b)
        for (unsigned int i = 0; i < n; ++i)
          rest[first + i] -= coefficients[b] * rows[b][first + i];
      const Monomials z = solve(A, size, rest);
      for (std::size_t b = 0; b < points.size(); ++b)
        for (unsigned int i = 0; i < size; ++i)
          coefficients[b] += z[i] * weighted[b][i];
    }
    return coefficients;
  }
} // namespace retroforge
