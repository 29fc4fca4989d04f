// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/element/mini_element.h>
#include <retroforge/element/tangent_pack.templates.h>

/// @file
/// What the tangent of the mini element and the equilibrium of its bubble have in common, for one cell or a
/// pack.
namespace retroforge
{
  /// Strain rates of the sub-tetrahedra and the derivatives of their stresses, times |T|/4:
  /// ds = 2 half * deps + rank_one * eps (eps:deps).
  template <typename T>
  struct TangentInput
  {
    T volume, g[4][3], eps[4][6], half[4], rank_one[4];
  };

  template <typename T>
  struct CellInput
  {
    T volume, g[4][3], V[4][3], beta[3];
  };

  inline CellInput<double>
  input_of(const CellGeometry<double> &geometry, const Four<Vec3> &V, const Vec3 &beta)
  {
    CellInput<double> cell;
    cell.volume = geometry.volume;
    for (unsigned int i = 0; i < 3; ++i)
    {
      for (unsigned int c = 0; c < 4; ++c)
      {
        cell.g[c][i] = geometry.g[c][i];
        cell.V[c][i] = V[c][i];
      }
      cell.beta[i] = beta[i];
    }
    return cell;
  }

  inline CellInput<Pack> input_of(const std::array<CellGeometry<double>, n_lanes> &geometry,
                                  const std::array<CellValues<double>, n_lanes>   &w)
  {
    CellInput<Pack> pack;
    for (unsigned int lane = 0; lane < n_lanes; ++lane)
    {
      CellInput<double> cell = input_of(geometry[lane], w[lane].V, w[lane].beta);
      for_each_entry(pack, cell, [lane](double &p, const double &x) { (&p)[lane] = x; });
    }
    return pack;
  }

  template <typename T>
  RETROFORGE_INLINE void add_dyad(const T (&v)[3], const double scale, const T (&g)[3], T (&e)[6])
  {
    e[0] += scale * v[0] * g[0];
    e[1] += scale * v[1] * g[1];
    e[2] += scale * v[2] * g[2];
    e[3] += 0.5 * scale * (v[1] * g[2] + v[2] * g[1]);
    e[4] += 0.5 * scale * (v[0] * g[2] + v[2] * g[0]);
    e[5] += 0.5 * scale * (v[0] * g[1] + v[1] * g[0]);
  }

  /// @param law  of the cell, or LaneLaws
  template <typename T, typename Law>
  RETROFORGE_INLINE void fill(const CellInput<T> &cell, const Law &law, TangentInput<T> &input)
  {
    input.volume      = cell.volume;
    const T quarter   = 0.25 * cell.volume;
    T       linear[6] = {};
    for (unsigned int c = 0; c < 4; ++c)
    {
      add_dyad(cell.V[c], 1., cell.g[c], linear);
      for (unsigned int i = 0; i < 3; ++i)
        input.g[c][i] = cell.g[c][i];
    }
    for (unsigned int a = 0; a < 4; ++a)
    {
      auto &eps = input.eps[a];
      for (unsigned int i = 0; i < 6; ++i)
        eps[i] = linear[i];
      add_dyad(cell.beta, 4., cell.g[a], eps);
      T factor, slope;
      evaluate_law(law, square(eps), factor, slope);
      factor            = quarter * factor;
      input.half[a]     = 0.5 * factor;
      input.rank_one[a] = 2. * slope * factor;
    }
  }

  /// Inverse of a symmetric matrix.
  template <typename T>
  RETROFORGE_INLINE void invert(const T (&A)[3][3], T (&inverse)[3][3])
  {
    const T c00 = A[1][1] * A[2][2] - A[1][2] * A[2][1], c01 = A[1][2] * A[2][0] - A[1][0] * A[2][2],
            c02   = A[1][0] * A[2][1] - A[1][1] * A[2][0];
    const T d     = 1. / (A[0][0] * c00 + A[0][1] * c01 + A[0][2] * c02);
    inverse[0][0] = c00 * d;
    inverse[0][1] = inverse[1][0] = c01 * d;
    inverse[0][2] = inverse[2][0] = c02 * d;
    inverse[1][1]                 = (A[0][0] * A[2][2] - A[0][2] * A[2][0]) * d;
    inverse[1][2] = inverse[2][1] = (A[0][1] * A[2][0] - A[0][0] * A[2][1]) * d;
    inverse[2][2]                 = (A[0][0] * A[1][1] - A[0][1] * A[1][0]) * d;
  }

  /// Second derivatives in the bubble.
  template <typename T>
  RETROFORGE_INLINE void bubble_block(const TangentInput<T> &in, const bool linear, T (&block)[3][3])
  {
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        block[i][j] = T{};
    for (unsigned int a = 0; a < 4; ++a)
    {
      const T h = 16. * in.half[a], r = 16. * in.rank_one[a], diagonal = h * dot(in.g[a], in.g[a]);
      T       y[3] = {};
      if (!linear)
        eps_times_g(in.eps[a], in.g[a], y);
      for (unsigned int i = 0; i < 3; ++i)
      {
        block[i][i] += diagonal;
        for (unsigned int j = 0; j < 3; ++j)
          block[i][j] += h * in.g[a][i] * in.g[a][j] + r * y[i] * y[j];
      }
    }
  }
} // namespace retroforge
