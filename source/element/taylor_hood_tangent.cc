// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/element/tangent_pack.templates.h>
#include <retroforge/element/taylor_hood.templates.h>

namespace retroforge
{
  namespace
  {
    template <typename T>
    struct TaylorHoodTangentInput
    {
      T volume, g[4][3], V[10][3];
    };

    RETROFORGE_INLINE constexpr double lambda(const unsigned int c, const unsigned int q)
    {
      return c == q ? point_lambda_own : point_lambda_else;
    }

    /// What stands for the gradients of the nodes' functions at point q, f_c standing for g_c:
    /// (4 lambda_c - 1) f_c  of a corner and  4 (lambda_c f_d + lambda_d f_c)  of a middle.
    template <typename T>
    RETROFORGE_INLINE void combine(const T (&f)[4][3], const unsigned int q, T (&y)[10][3])
    {
      for (unsigned int i = 0; i < 3; ++i)
      {
        for (unsigned int c = 0; c < 4; ++c)
          y[c][i] = (4. * lambda(c, q) - 1.) * f[c][i];
        for (unsigned int e = 0; e < 6; ++e)
        {
          const unsigned int c = tet_edge_corners[e][0], d = tet_edge_corners[e][1];
          y[4 + e][i] = 4. * lambda(c, q) * f[d][i] + 4. * lambda(d, q) * f[c][i];
        }
      }
    }

    /// As TaylorHoodRates.
    template <typename T>
    RETROFORGE_INLINE void strain_rates(const TaylorHoodTangentInput<T> &in, T (&eps)[4][6])
    {
      T L[4][3][3] = {};
      for (unsigned int c = 0; c < 4; ++c)
        for (unsigned int i = 0; i < 3; ++i)
        {
          T W[4], sum = T{};
          for (unsigned int d = 0; d < 4; ++d)
          {
            W[d] = in.V[node_between[c][d]][i];
            sum += W[d];
          }
          const T rest = 4. * point_lambda_else * sum - in.V[c][i];
          for (unsigned int q = 0; q < 4; ++q)
          {
            const T U = rest + 4. * (point_lambda_own - point_lambda_else) * W[q];
            for (unsigned int j = 0; j < 3; ++j)
              L[q][i][j] += U * in.g[c][j];
          }
        }
      for (unsigned int q = 0; q < 4; ++q)
        for (unsigned int i = 0; i < 3; ++i)
        {
          const unsigned int j = (i + 1) % 3, k = (i + 2) % 3;
          eps[q][i]     = L[q][i][i];
          eps[q][3 + i] = 0.5 * (L[q][j][k] + L[q][k][j]);
        }
    }

    /// What the velocity's second derivatives are made of: those of the stresses, times |T|/4, are
    /// ds = 2 half * deps + rank_one * eps (eps:deps)  at each point.
    template <typename T>
    struct Viscous
    {
      T K[4][4][3][3];        ///< g_d (x) g_c + g_c·g_d I
      T h, h_1[4], h_2[4][4]; ///< sums over the points of half times 1, 4 lambda_a, 16 lambda_a lambda_b
      T rank_one[4];
      T y[4][10][3]; ///< eps_q times the gradients of the nodes' functions
    };

    template <typename T>
    RETROFORGE_INLINE void fill(const T (&g)[4][3], const T (&half)[4], Viscous<T> &v)
    {
      for (unsigned int c = 0; c < 4; ++c)
        for (unsigned int d = 0; d < 4; ++d)
          for (unsigned int i = 0; i < 3; ++i)
            for (unsigned int j = 0; j < 3; ++j)
              v.K[c][d][i][j] = g[d][i] * g[c][j] + (i == j ? dot(g[c], g[d]) : T{});
      constexpr double own = 4. * (point_lambda_own - point_lambda_else), rest = 4. * point_lambda_else;
      v.h = half[0] + half[1] + half[2] + half[3];
      for (unsigned int a = 0; a < 4; ++a)
      {
        v.h_1[a] = rest * v.h + own * half[a];
        for (unsigned int b = 0; b < 4; ++b)
          v.h_2[a][b] = rest * rest * v.h + rest * own * (half[a] + half[b]);
        v.h_2[a][a] += own * own * half[a];
      }
    }

    template <typename T>
    RETROFORGE_INLINE void add_scaled(const T &factor, const T (&K)[3][3], T (&block)[3][3])
    {
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          block[i][j] += factor * K[i][j];
    }

    /// Adds  sum_q rank_one_q y_q,n (x) y_q,m  to a block unless the stresses are linear, and writes it to
    /// both sides of the diagonal.
    template <typename T>
    RETROFORGE_INLINE void finish(const T (&rank_one)[4],
                                  const T (&y)[4][10][3],
                                  const bool         linear,
                                  const unsigned int n,
                                  const unsigned int m,
                                  T (&block)[3][3],
                                  T (&A)[10][10][3][3])
    {
      if (!linear)
        for (unsigned int q = 0; q < 4; ++q)
          for (unsigned int i = 0; i < 3; ++i)
          {
            const T scaled = rank_one[q] * y[q][n][i];
            for (unsigned int j = 0; j < 3; ++j)
              block[i][j] += scaled * y[q][m][j];
          }
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
        {
          A[n][m][i][j] = block[i][j];
          A[m][n][j][i] = block[i][j];
        }
    }

    template <typename T>
    RETROFORGE_INLINE void velocity_blocks(const Viscous<T> &v, const bool linear, TaylorHoodBlocks<T> &t)
    {
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int b = 0; b <= a; ++b)
        {
          T block[3][3] = {};
          add_scaled(v.h_2[a][b] - v.h_1[a] - v.h_1[b] + v.h, v.K[a][b], block);
          finish(v.rank_one, v.y, linear, a, b, block, t.A);
        }
      for (unsigned int e = 0; e < 6; ++e)
      {
        const unsigned int a = tet_edge_corners[e][0], b = tet_edge_corners[e][1];
        for (unsigned int c = 0; c < 4; ++c)
        {
          T block[3][3] = {};
          add_scaled(v.h_2[a][c] - v.h_1[a], v.K[b][c], block);
          add_scaled(v.h_2[b][c] - v.h_1[b], v.K[a][c], block);
          finish(v.rank_one, v.y, linear, 4 + e, c, block, t.A);
        }
        for (unsigned int f = 0; f <= e; ++f)
        {
          const unsigned int c = tet_edge_corners[f][0], d = tet_edge_corners[f][1];
          T                  block[3][3] = {};
          add_scaled(v.h_2[a][c], v.K[b][d], block);
          add_scaled(v.h_2[a][d], v.K[b][c], block);
          add_scaled(v.h_2[b][c], v.K[a][d], block);
          add_scaled(v.h_2[b][d], v.K[a][c], block);
          finish(v.rank_one, v.y, linear, 4 + e, 4 + f, block, t.A);
        }
      }
    }

    /// - int lambda_k grad N_n:  linear times linear, in closed form.
    template <typename T>
    RETROFORGE_INLINE void pressure_blocks(const TaylorHoodTangentInput<T> &in, TaylorHoodBlocks<T> &t)
    {
      for (unsigned int i = 0; i < 3; ++i)
      {
        T scaled[4];
        for (unsigned int c = 0; c < 4; ++c)
          scaled[c] = -0.05 * in.volume * in.g[c][i];
        for (unsigned int k = 0; k < 4; ++k)
        {
          for (unsigned int c = 0; c < 4; ++c)
            t.B[c][k][i] = (c == k ? 3. : -1.) * scaled[c];
          for (unsigned int e = 0; e < 6; ++e)
          {
            const unsigned int c = tet_edge_corners[e][0], d = tet_edge_corners[e][1];
            t.B[4 + e][k][i] = (k == c ? 8. : 4.) * scaled[d] + (k == d ? 8. : 4.) * scaled[c];
          }
        }
      }
    }

    template <typename T, typename Law>
    RETROFORGE_INLINE void tangent_blocks(const TaylorHoodTangentInput<T> &in,
                                          const Law                       &law,
                                          const Linearisation              linearisation,
                                          TaylorHoodBlocks<T>             &t)
    {
      const bool linear  = is_linear(law) || linearisation == Linearisation::picard;
      const T    quarter = 0.25 * in.volume;
      T          eps[4][6], half[4];
      Viscous<T> v;
      strain_rates(in, eps);
      for (unsigned int q = 0; q < 4; ++q)
      {
        T factor, slope;
        evaluate_law(law, square(eps[q]), factor, slope);
        half[q]       = 0.5 * quarter * factor;
        v.rank_one[q] = 4. * slope * half[q];
        T z[4][3];
        for (unsigned int c = 0; c < 4; ++c)
          eps_times_g(eps[q], in.g[c], z[c]);
        combine(z, q, v.y[q]);
      }
      fill(in.g, half, v);
      t.volume    = in.volume;
      t.viscosity = v.h / in.volume;
      velocity_blocks(v, linear, t);
      pressure_blocks(in, t);
    }

    RETROFORGE_ALSO_FOR("fma")
    void tangent_pack(const TaylorHoodTangentInput<Pack> &input,
                      const LaneLaws                     &laws,
                      const Linearisation                 linearisation,
                      TaylorHoodPack                     &tangent)
    {
      tangent_blocks(input, laws, linearisation, tangent);
    }

    TaylorHoodTangentInput<double> input_of(const CellGeometry<double>     &geometry,
                                            const TaylorHoodValues<double> &w)
    {
      TaylorHoodTangentInput<double> input;
      input.volume = geometry.volume;
      for (unsigned int i = 0; i < 3; ++i)
      {
        for (unsigned int c = 0; c < 4; ++c)
          input.g[c][i] = geometry.g[c][i];
        for (unsigned int n = 0; n < 10; ++n)
          input.V[n][i] = w.V[n][i];
      }
      return input;
    }
  } // namespace

  void compute_cell_tangent(const CellGeometry<double>     &geometry,
                            const TaylorHoodValues<double> &w,
                            const MaterialLaw<double>      &law,
                            const Linearisation             linearisation,
                            TaylorHoodTangent              &tangent)
  {
    tangent_blocks(input_of(geometry, w), law, linearisation, tangent);
  }

  void compute_cell_tangents(const std::array<CellGeometry<double>, n_lanes>     &geometry,
                             const std::array<TaylorHoodValues<double>, n_lanes> &w,
                             const LaneLaws                                      &laws,
                             const Linearisation                                  linearisation,
                             TaylorHoodPack                                      &tangent)
  {
    TaylorHoodTangentInput<Pack> pack;
    for (unsigned int lane = 0; lane < n_lanes; ++lane)
    {
      TaylorHoodTangentInput<double> input = input_of(geometry[lane], w[lane]);
      for_each_entry(pack, input, [lane](double &p, const double &x) { (&p)[lane] = x; });
    }
    tangent_pack(pack, laws, linearisation, tangent);
  }
} // namespace retroforge
