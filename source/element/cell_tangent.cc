// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/element/mini_pack.templates.h>

namespace retroforge
{
  namespace
  {
    template <typename T>
    RETROFORGE_INLINE void tangent_blocks(const TangentInput<T> &in, const bool linear, TangentBlocks<T> &t)
    {
      const auto &g        = in.g;
      const T     quarter  = 0.25 * in.volume;
      const T     half_sum = in.half[0] + in.half[1] + in.half[2] + in.half[3];
      t.volume             = in.volume;
      t.viscosity          = half_sum / in.volume;

      T y[4][4][3]; // y[a][c] = eps_a g_c
      if (!linear)
        for (unsigned int a = 0; a < 4; ++a)
          for (unsigned int c = 0; c < 4; ++c)
            eps_times_g(in.eps[a], g[c], y[a][c]);
      T gg[4][4];
      for (unsigned int c = 0; c < 4; ++c)
        for (unsigned int d = 0; d <= c; ++d)
          gg[c][d] = gg[d][c] = dot(g[c], g[d]);

      T bubble[3][3];
      bubble_block(in, linear, bubble);
      invert(bubble, t.M);

      T h[3];
      for (unsigned int i = 0; i < 3; ++i)
        h[i] =
          4. * (in.half[0] * g[0][i] + in.half[1] * g[1][i] + in.half[2] * g[2][i] + in.half[3] * g[3][i]);
      T VbM[4][3][3];
      for (unsigned int c = 0; c < 4; ++c)
      {
        auto   &N        = t.Vb[c];
        const T diagonal = 4. * (in.half[0] * gg[c][0] + in.half[1] * gg[c][1] + in.half[2] * gg[c][2] +
                                 in.half[3] * gg[c][3]);
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j)
            N[i][j] = h[i] * g[c][j];
        for (unsigned int i = 0; i < 3; ++i)
          N[i][i] += diagonal;
        if (!linear)
          for (unsigned int a = 0; a < 4; ++a)
            for (unsigned int i = 0; i < 3; ++i)
            {
              const T scaled = 4. * in.rank_one[a] * y[a][c][i];
              for (unsigned int j = 0; j < 3; ++j)
                N[i][j] += scaled * y[a][a][j];
            }
        for (unsigned int i = 0; i < 3; ++i)
        {
          t.Pb[c][i] = quarter * g[c][i];
          for (unsigned int j = 0; j < 3; ++j)
            VbM[c][i][j] = N[i][0] * t.M[0][j] + N[i][1] * t.M[1][j] + N[i][2] * t.M[2][j];
        }
      }

      for (unsigned int c = 0; c < 4; ++c)
        for (unsigned int i = 0; i < 3; ++i)
        {
          T scaled[4];
          if (!linear)
            for (unsigned int a = 0; a < 4; ++a)
              scaled[a] = in.rank_one[a] * y[a][c][i];
          for (unsigned int d = 0; d <= c; ++d)
            for (unsigned int j = 0; j < 3; ++j)
            {
              T sum = half_sum * g[d][i] * g[c][j] - dot(VbM[c][i], t.Vb[d][j]);
              if (!linear)
                sum += scaled[0] * y[0][d][j] + scaled[1] * y[1][d][j] + scaled[2] * y[2][d][j] +
                       scaled[3] * y[3][d][j];
              if (i == j)
                sum += half_sum * gg[c][d];
              t.A[c][d][i][j] = sum;
              t.A[d][c][j][i] = sum;
            }
          for (unsigned int d = 0; d < 4; ++d)
            t.B[c][d][i] = -quarter * g[c][i] - dot(VbM[c][i], t.Pb[d]);
        }
      for (unsigned int c = 0; c < 4; ++c)
      {
        T PbM[3];
        for (unsigned int i = 0; i < 3; ++i)
          PbM[i] = t.Pb[c][0] * t.M[0][i] + t.Pb[c][1] * t.M[1][i] + t.Pb[c][2] * t.M[2][i];
        for (unsigned int d = 0; d < 4; ++d)
          t.C[c][d] = -dot(PbM, t.Pb[d]);
      }
    }

    RETROFORGE_ALSO_FOR("fma")
    void
    tangent_pack(const CellInput<Pack> &cell, const LaneLaws &laws, const bool linear, TangentPack &tangent)
    {
      TangentInput<Pack> input;
      fill(cell, laws, input);
      tangent_blocks(input, linear, tangent);
    }

    Vec3 multiply(const double (&A)[3][3], const Vec3 &x)
    {
      Vec3 y;
      for (unsigned int i = 0; i < 3; ++i)
        y[i] = A[i][0] * x[0] + A[i][1] * x[1] + A[i][2] * x[2];
      return y;
    }
  } // namespace

  void compute_cell_tangent(const CellGeometry<double> &geometry,
                            const CellValues<double>   &w,
                            const MaterialLaw<double>  &law,
                            CellTangent                &tangent)
  {
    TangentInput<double> input;
    fill(input_of(geometry, w.V, w.beta), law, input);
    tangent_blocks(input, law.is_linear(), tangent);
  }

  void compute_cell_tangents(const std::array<CellGeometry<double>, n_lanes>        &geometry,
                             const std::array<CellValues<double>, n_lanes>          &w,
                             const LaneLaws                                         &laws,
                             const Linearisation                                     linearisation,
                             TangentPack                                            &tangent,
                             const std::array<BubbleElimination<double> *, n_lanes> &elimination)
  {
    tangent_pack(
      input_of(geometry, w), laws, is_linear(laws) || linearisation == Linearisation::picard, tangent);
    for (unsigned int lane = 0; lane < n_lanes; ++lane)
      for_each_entry(static_cast<BubbleElimination<Pack> &>(tangent),
                     *elimination[lane],
                     [lane](const double &p, double &x) { x = (&p)[lane]; });
  }

  template <>
  Vec3 BubbleElimination<double>::recover_bubble(const Vec3         &rhs_beta,
                                                 const Four<Vec3>   &V,
                                                 const Four<double> &P) const
  {
    Vec3 rhs = rhs_beta;
    for (unsigned int c = 0; c < 4; ++c)
      for (unsigned int j = 0; j < 3; ++j)
        rhs[j] -= Vb[c][0][j] * V[c][0] + Vb[c][1][j] * V[c][1] + Vb[c][2][j] * V[c][2] + Pb[c][j] * P[c];
    return multiply(M, rhs);
  }

  template <>
  void BubbleElimination<double>::condense(CellValues<double> &rhs) const
  {
    const Vec3 b = multiply(M, rhs.beta);
    for (unsigned int c = 0; c < 4; ++c)
    {
      rhs.V[c] -= multiply(Vb[c], b);
      rhs.P[c] -= Pb[c][0] * b[0] + Pb[c][1] * b[1] + Pb[c][2] * b[2];
    }
  }
} // namespace retroforge
