// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/element/mini_element.h>
#include <retroforge/element/mini_element.templates.h>

namespace retroforge
{
  namespace
  {
    using Symmetric = std::array<double, 6>;

    void add(Symmetric &sum, const double factor, const Symmetric &e)
    {
      for (unsigned int k = 0; k < 6; ++k)
        sum[k] += factor * e[k];
    }

    /// g_bar of a strain-rate functional: E_a = d/d(eps_a) meets eps_a = sym(sum_c V_c (x) g_c + 4 beta (x) g_a).
    void add_strain_pullback(const Four<Symmetric> &E, const Four<Vec3> &V, const Vec3 &beta, Four<Vec3> &g_bar)
    {
      Symmetric sum = {};
      for (const auto &e : E)
        add(sum, 1., e);
      for (unsigned int c = 0; c < 4; ++c)
        g_bar[c] += times(sum, V[c]) + 4. * times(E[c], beta);
    }

    void invert(const double (&A)[3][3], double (&inverse)[3][3])
    {
      const double c00 = A[1][1] * A[2][2] - A[1][2] * A[2][1], c01 = A[1][2] * A[2][0] - A[1][0] * A[2][2],
                   c02 = A[1][0] * A[2][1] - A[1][1] * A[2][0];
      const double d   = 1. / (A[0][0] * c00 + A[0][1] * c01 + A[0][2] * c02);
      inverse[0][0]    = c00 * d;
      inverse[0][1] = inverse[1][0] = c01 * d;
      inverse[0][2] = inverse[2][0] = c02 * d;
      inverse[1][1]                 = (A[0][0] * A[2][2] - A[0][2] * A[2][0]) * d;
      inverse[1][2] = inverse[2][1] = (A[0][1] * A[2][0] - A[0][0] * A[2][1]) * d;
      inverse[2][2]                 = (A[0][0] * A[1][1] - A[0][1] * A[1][0]) * d;
    }

    Vec3 multiply(const double (&A)[3][3], const Vec3 &x)
    {
      Vec3 y;
      for (unsigned int i = 0; i < 3; ++i)
        y[i] = A[i][0] * x[0] + A[i][1] * x[1] + A[i][2] * x[2];
      return y;
    }

    /// Derivatives of the stress: ds = factor * deps + rank_one * eps (eps:deps), times |T|/4.
    struct StressDerivative
    {
      double factor, rank_one;

      StressDerivative(const NortonHoff<double> &law, const Symmetric &eps, const double quarter)
      {
        const double q = law.q(double_contraction(eps, eps));
        factor         = quarter * law.stress_factor(q);
        rank_one       = law.m == 1. ? 0. : 2. * (law.m - 1.) / q * factor;
      }
    };
  } // namespace

  template CellGeometry<double> cell_geometry(const Four<Vector3<double>> &);
  template CellGeometry<Dual>   cell_geometry(const Four<Vector3<Dual>> &);
#define RETROFORGE_INSTANTIATE(Number)                                                                              \
  template Number cell_functional(const CellGeometry<Number> &, const CellValues<Number> &, const NortonHoff<Number> &); \
  template CellValues<Number> cell_residual(const CellGeometry<Number> &,                                          \
                                            const CellValues<Number> &,                                            \
                                            const NortonHoff<Number> &);                                           \
  template Number cell_dissipation(const CellGeometry<Number> &, const CellValues<Number> &, const NortonHoff<Number> &);
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE

  void reverse_cell_geometry(const CellGeometry<double> &geometry,
                             const double                volume_bar,
                             const Four<Vec3>           &g_bar,
                             Four<Vec3>                 &X_bar)
  {
    const auto &g = geometry.g;
    for (unsigned int c = 0; c < 4; ++c)
      {
        X_bar[c] += geometry.volume * volume_bar * g[c];
        for (unsigned int a = 0; a < 4; ++a)
          X_bar[c] -= (g[c] * g_bar[a]) * g[a];
      }
  }

  Four<double> cell_strain_rates(const CellGeometry<double> &geometry, const CellValues<double> &w)
  {
    const SubStrainRates<double> rates(geometry, w.V, w.beta);
    Four<double>                 e;
    for (unsigned int a = 0; a < 4; ++a)
      e[a] = std::sqrt(2. / 3. * double_contraction(rates.eps[a], rates.eps[a]));
    return e;
  }

  CellSensitivity reverse_cell_residual(const CellGeometry<double> &geometry,
                                        const CellValues<double>   &w,
                                        const CellValues<double>   &lambda,
                                        const NortonHoff<double>   &law)
  {
    const double                 quarter = 0.25 * geometry.volume;
    const SubStrainRates<double> eps(geometry, w.V, w.beta), eta(geometry, lambda.V, lambda.beta);
    CellSensitivity              bar;
    Four<Symmetric>              E, H;
    double                       viscous = 0.;
    for (unsigned int a = 0; a < 4; ++a)
      {
        const double q       = law.q(double_contraction(eps.eps[a], eps.eps[a]));
        const double factor  = quarter * law.stress_factor(q);
        const double product = double_contraction(eps.eps[a], eta.eps[a]);
        const double slope   = law.m == 1. ? 0. : (law.m - 1.) / q;
        for (unsigned int k = 0; k < 6; ++k)
          {
            E[a][k] = factor * (eta.eps[a][k] + 2. * slope * product * eps.eps[a][k]);
            H[a][k] = factor * eps.eps[a][k];
          }
        viscous += factor * product;
        bar.m += factor * product * 0.5 * log_or_zero(q);
        bar.e0 += factor * product * slope * 3. * law.e0;
      }
    bar.K = viscous / law.K;

    const double p_sum = quarter * (w.P[0] + w.P[1] + w.P[2] + w.P[3]);
    const double lambda_p_sum = quarter * (lambda.P[0] + lambda.P[1] + lambda.P[2] + lambda.P[3]);
    Four<Vec3>   g_bar = {};
    add_strain_pullback(E, w.V, w.beta, g_bar);
    add_strain_pullback(H, lambda.V, lambda.beta, g_bar);
    for (unsigned int c = 0; c < 4; ++c)
      g_bar[c] += -p_sum * lambda.V[c] - lambda_p_sum * w.V[c] + quarter * (w.P[c] * lambda.beta + lambda.P[c] * w.beta);

    const double scalar = viscous - p_sum * divergence(geometry, lambda.V) - lambda_p_sum * divergence(geometry, w.V) +
                          quarter * (lambda.beta * pressure_gradient(geometry, w.P) +
                                     w.beta * pressure_gradient(geometry, lambda.P));
    reverse_cell_geometry(geometry, scalar / geometry.volume, g_bar, bar.X);
    return bar;
  }

  CellSensitivity reverse_cell_dissipation(const CellGeometry<double> &geometry,
                                           const CellValues<double>   &w,
                                           const NortonHoff<double>   &law,
                                           const double                weight,
                                           CellValues<double>         &w_bar)
  {
    const double                 quarter = 0.25 * geometry.volume * weight;
    const SubStrainRates<double> rates(geometry, w.V, w.beta);
    CellSensitivity              bar;
    Four<Symmetric>              E;
    Symmetric                    E_sum = {};
    double                       power = 0.;
    for (unsigned int a = 0; a < 4; ++a)
      {
        const double eps2   = double_contraction(rates.eps[a], rates.eps[a]);
        const double q      = law.q(eps2);
        const double factor = quarter * law.stress_factor(q);
        const double slope  = law.m == 1. ? 0. : (law.m - 1.) / q;
        for (unsigned int k = 0; k < 6; ++k)
          E[a][k] = factor * 2. * (1. + slope * eps2) * rates.eps[a][k];
        add(E_sum, 1., E[a]);
        power += factor * eps2;
        bar.m += factor * eps2 * 0.5 * log_or_zero(q);
        bar.e0 += factor * eps2 * slope * 3. * law.e0;
      }
    bar.K = power / law.K;
    for (unsigned int c = 0; c < 4; ++c)
      {
        w_bar.V[c] += times(E_sum, geometry.g[c]);
        w_bar.beta += 4. * times(E[c], geometry.g[c]);
      }
    Four<Vec3> g_bar = {};
    add_strain_pullback(E, w.V, w.beta, g_bar);
    reverse_cell_geometry(geometry, power / geometry.volume, g_bar, bar.X);
    return bar;
  }

  void compute_cell_tangent(const CellGeometry<double> &geometry,
                            const CellValues<double>   &w,
                            const NortonHoff<double>   &law,
                            CellTangent                &t)
  {
    const double                 quarter = 0.25 * geometry.volume;
    const auto                  &g       = geometry.g;
    const SubStrainRates<double> rates(geometry, w.V, w.beta);
    const bool                   linear = law.m == 1.;

    double half[4], rank_one[4], half_sum = 0.;
    Vec3   y[4][4]; // y[a][c] = eps_a g_c
    for (unsigned int a = 0; a < 4; ++a)
      {
        const StressDerivative s(law, rates.eps[a], quarter);
        half[a]     = 0.5 * s.factor;
        rank_one[a] = s.rank_one;
        half_sum += half[a];
        if (!linear)
          for (unsigned int c = 0; c < 4; ++c)
            y[a][c] = times(rates.eps[a], g[c]);
      }
    t.viscosity = half_sum / geometry.volume;

    double gg[4][4];
    for (unsigned int c = 0; c < 4; ++c)
      for (unsigned int d = 0; d <= c; ++d)
        gg[c][d] = gg[d][c] = g[c] * g[d];

    double bubble[3][3] = {};
    for (unsigned int a = 0; a < 4; ++a)
      for (unsigned int i = 0; i < 3; ++i)
        {
          bubble[i][i] += 16. * half[a] * gg[a][a];
          for (unsigned int j = 0; j < 3; ++j)
            bubble[i][j] += 16. * half[a] * g[a][i] * g[a][j];
        }
    if (!linear)
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j)
            bubble[i][j] += 16. * rank_one[a] * y[a][a][i] * y[a][a][j];
    invert(bubble, t.M);

    double VbM[4][3][3];
    for (unsigned int c = 0; c < 4; ++c)
      {
        auto  &N = t.Vb[c];
        double diagonal = 0., h[3] = {0., 0., 0.};
        for (unsigned int a = 0; a < 4; ++a)
          {
            diagonal += 4. * half[a] * gg[c][a];
            for (unsigned int i = 0; i < 3; ++i)
              h[i] += 4. * half[a] * g[a][i];
          }
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j)
            N[i][j] = h[i] * g[c][j] + (i == j ? diagonal : 0.);
        if (!linear)
          for (unsigned int a = 0; a < 4; ++a)
            for (unsigned int i = 0; i < 3; ++i)
              for (unsigned int j = 0; j < 3; ++j)
                N[i][j] += 4. * rank_one[a] * y[a][c][i] * y[a][a][j];
        for (unsigned int i = 0; i < 3; ++i)
          {
            t.Pb[c][i] = quarter * g[c][i];
            for (unsigned int j = 0; j < 3; ++j)
              VbM[c][i][j] = N[i][0] * t.M[0][j] + N[i][1] * t.M[1][j] + N[i][2] * t.M[2][j];
          }
      }

    for (unsigned int c = 0; c < 4; ++c)
      for (unsigned int d = 0; d <= c; ++d)
        {
          auto &A = t.A[c][d];
          for (unsigned int i = 0; i < 3; ++i)
            for (unsigned int j = 0; j < 3; ++j)
              {
                double sum = half_sum * g[d][i] * g[c][j];
                if (!linear)
                  for (unsigned int a = 0; a < 4; ++a)
                    sum += rank_one[a] * y[a][c][i] * y[a][d][j];
                A[i][j] = sum - VbM[c][i][0] * t.Vb[d][j][0] - VbM[c][i][1] * t.Vb[d][j][1] -
                          VbM[c][i][2] * t.Vb[d][j][2];
              }
          for (unsigned int i = 0; i < 3; ++i)
            A[i][i] += half_sum * gg[c][d];
          if (c != d)
            for (unsigned int i = 0; i < 3; ++i)
              for (unsigned int j = 0; j < 3; ++j)
                t.A[d][c][j][i] = A[i][j];
        }
    for (unsigned int c = 0; c < 4; ++c)
      {
        double PbM[3];
        for (unsigned int i = 0; i < 3; ++i)
          PbM[i] = t.Pb[c][0] * t.M[0][i] + t.Pb[c][1] * t.M[1][i] + t.Pb[c][2] * t.M[2][i];
        for (unsigned int d = 0; d < 4; ++d)
          {
            t.C[c][d] = -(PbM[0] * t.Pb[d][0] + PbM[1] * t.Pb[d][1] + PbM[2] * t.Pb[d][2]);
            for (unsigned int i = 0; i < 3; ++i)
              t.B[c][d][i] = -quarter * g[c][i] - VbM[c][i][0] * t.Pb[d][0] - VbM[c][i][1] * t.Pb[d][1] -
                             VbM[c][i][2] * t.Pb[d][2];
          }
      }
  }

  Vec3 CellTangent::recover_bubble(const Vec3 &rhs_beta, const Four<Vec3> &V, const Four<double> &P) const
  {
    Vec3 rhs = rhs_beta;
    for (unsigned int c = 0; c < 4; ++c)
      for (unsigned int j = 0; j < 3; ++j)
        rhs[j] -= Vb[c][0][j] * V[c][0] + Vb[c][1][j] * V[c][1] + Vb[c][2][j] * V[c][2] + Pb[c][j] * P[c];
    return multiply(M, rhs);
  }

  void CellTangent::condense(CellValues<double> &rhs) const
  {
    const Vec3 b = multiply(M, rhs.beta);
    for (unsigned int c = 0; c < 4; ++c)
      {
        rhs.V[c] -= multiply(Vb[c], b);
        rhs.P[c] -= Pb[c][0] * b[0] + Pb[c][1] * b[1] + Pb[c][2] * b[2];
      }
  }

  Vec3 solve_bubble(const CellGeometry<double> &geometry, const CellValues<double> &w, const NortonHoff<double> &law)
  {
    CellValues<double> trial = w;
    const auto functional = [&](const Vec3 &beta) {
      trial.beta = beta;
      return cell_functional(geometry, trial, law);
    };
    CellTangent tangent;
    Vec3        beta = w.beta;
    double      last = std::numeric_limits<double>::max();
    for (unsigned int iteration = 0; iteration < 60; ++iteration)
      {
        trial.beta          = beta;
        const Vec3 residual = cell_residual(geometry, trial, law).beta;
        compute_cell_tangent(geometry, trial, law, tangent);
        const Vec3   step      = -multiply(tangent.M, residual);
        const double decrement = -(step * residual);
        // Quadratic convergence has reached rounding when the Newton decrement no longer falls.
        if (!(decrement > 0.) || (decrement >= last && iteration > 3 && step.norm() <= 1e-9 * (beta.norm() + step.norm())))
          break;
        double       scale = 1.;
        const double value = functional(beta);
        while (scale > 1e-4 && functional(beta + scale * step) > value - 1e-4 * scale * decrement + 1e-14 * std::abs(value))
          scale *= 0.5;
        beta += scale * step;
        last = scale == 1. ? decrement : std::numeric_limits<double>::max();
        if (step.norm() <= 1e-15 * beta.norm())
          break;
      }
    return beta;
  }
} // namespace retroforge
