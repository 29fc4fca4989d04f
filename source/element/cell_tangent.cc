// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/element/mini_element.h>
#include <retroforge/element/mini_element.templates.h>
#include <retroforge/element/tangent_pack.templates.h>

namespace retroforge
{
  namespace
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

    CellInput<double> input_of(const CellGeometry<double> &geometry, const Four<Vec3> &V, const Vec3 &beta)
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

    template <typename T>
    RETROFORGE_INLINE void
    fill(const CellInput<T> &cell, const MaterialLaw<double> &law, TangentInput<T> &input)
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
        ask_law(law, square(eps), factor, slope);
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
    void tangent_pack(const CellInput<Pack>     &cell,
                      const MaterialLaw<double> &law,
                      const bool                 linear,
                      TangentPack               &tangent)
    {
      TangentInput<Pack> input;
      fill(cell, law, input);
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
                             const MaterialLaw<double>                              &law,
                             const Linearisation                                     linearisation,
                             TangentPack                                            &tangent,
                             const std::array<BubbleElimination<double> *, n_lanes> &elimination)
  {
    CellInput<Pack> pack;
    for (unsigned int lane = 0; lane < n_lanes; ++lane)
    {
      CellInput<double> cell = input_of(geometry[lane], w[lane].V, w[lane].beta);
      for_each_entry(pack, cell, [lane](double &p, const double &x) { (&p)[lane] = x; });
    }
    tangent_pack(pack, law, law.is_linear() || linearisation == Linearisation::picard, tangent);
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

  namespace
  {
    /// The functional of one cell as a function of its bubble alone.
    struct BubbleState
    {
      double value;
      Vec3   residual, newton_step;

      BubbleState(const CellGeometry<double> &geometry,
                  const CellValues<double>   &w,
                  const Vec3                 &grad_p,
                  const Vec3                 &beta,
                  const MaterialLaw<double>  &law)
      {
        TangentInput<double> in;
        fill(input_of(geometry, w.V, beta), law, in);
        residual = 0.25 * geometry.volume * grad_p;
        value    = residual * beta;
        for (unsigned int a = 0; a < 4; ++a)
        {
          double y[3];
          eps_times_g(in.eps[a], in.g[a], y);
          for (unsigned int i = 0; i < 3; ++i)
            residual[i] += 8. * in.half[a] * y[i];
          value += 2. * in.half[a] * law.potential_ratio(square(in.eps[a]));
        }
        double block[3][3], inverse[3][3];
        bubble_block(in, law.is_linear(), block);
        invert(block, inverse);
        newton_step = -multiply(inverse, residual);
      }
    };
  } // namespace

  Vec3 solve_bubble(const CellGeometry<double> &geometry,
                    const CellValues<double>   &w,
                    const MaterialLaw<double>  &law)
  {
    const Vec3 grad_p = pressure_gradient(geometry, w.P);
    double     spread = 0.;
    for (unsigned int c = 1; c < 4; ++c)
      spread += (w.V[c] - w.V[0]).norm();
    Vec3        beta = w.beta;
    BubbleState state(geometry, w, grad_p, beta, law);
    for (unsigned int iteration = 0; iteration < 60; ++iteration)
    {
      const Vec3   step      = state.newton_step;
      const double decrement = -(step * state.residual);
      if (!(decrement > 0.))
        break;
      // Convergence is quadratic: the error left by so small a step is below rounding.
      if (step.norm() <= 1e-9 * beta.norm() + 1e-16 * spread)
        return beta + step;
      double      scale = 1.;
      BubbleState next(geometry, w, grad_p, beta + step, law);
      while (scale > 1e-4 &&
             next.value > state.value - 1e-4 * scale * decrement + 1e-14 * std::abs(state.value))
      {
        scale *= 0.5;
        next = BubbleState(geometry, w, grad_p, beta + scale * step, law);
      }
      beta += scale * step;
      state = next;
    }
    return beta;
  }
} // namespace retroforge
