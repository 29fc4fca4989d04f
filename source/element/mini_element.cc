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

    /// g_bar of a strain-rate functional: E_a = d/d(eps_a) meets eps_a = sym(sum_c V_c (x) g_c + 4 beta (x)
    /// g_a).
    void
    add_strain_pullback(const Four<Symmetric> &E, const Four<Vec3> &V, const Vec3 &beta, Four<Vec3> &g_bar)
    {
      Symmetric sum = {};
      for (const auto &e : E)
        add(sum, 1., e);
      for (unsigned int c = 0; c < 4; ++c)
        g_bar[c] += times(sum, V[c]) + 4. * times(E[c], beta);
    }
  } // namespace

  template CellGeometry<double> cell_geometry(const Four<Vector3<double>> &);
  template CellGeometry<Dual>   cell_geometry(const Four<Vector3<Dual>> &);
#define RETROFORGE_INSTANTIATE(Number)                                                      \
  template Number cell_functional(                                                          \
    const CellGeometry<Number> &, const CellValues<Number> &, const MaterialLaw<Number> &); \
  template CellValues<Number> cell_residual(                                                \
    const CellGeometry<Number> &, const CellValues<Number> &, const MaterialLaw<Number> &); \
  template Number cell_dissipation(                                                         \
    const CellGeometry<Number> &, const CellValues<Number> &, const MaterialLaw<Number> &);
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
                                        const MaterialLaw<double>  &law)
  {
    const double                 quarter = 0.25 * geometry.volume;
    const SubStrainRates<double> eps(geometry, w.V, w.beta), eta(geometry, lambda.V, lambda.beta);
    CellSensitivity              bar;
    Four<Symmetric>              E, H;
    double                       viscous = 0.;
    for (unsigned int a = 0; a < 4; ++a)
    {
      const double eps2    = double_contraction(eps.eps[a], eps.eps[a]);
      const double factor  = quarter * law(eps2);
      const double product = double_contraction(eps.eps[a], eta.eps[a]);
      const double slope   = law.slope(eps2);
      for (unsigned int k = 0; k < 6; ++k)
      {
        E[a][k] = factor * (eta.eps[a][k] + 2. * slope * product * eps.eps[a][k]);
        H[a][k] = factor * eps.eps[a][k];
      }
      viscous += factor * product;
      law.reverse(eps2, factor * product, bar.law);
    }

    const double p_sum        = quarter * (w.P[0] + w.P[1] + w.P[2] + w.P[3]);
    const double lambda_p_sum = quarter * (lambda.P[0] + lambda.P[1] + lambda.P[2] + lambda.P[3]);
    Four<Vec3>   g_bar        = {};
    add_strain_pullback(E, w.V, w.beta, g_bar);
    add_strain_pullback(H, lambda.V, lambda.beta, g_bar);
    for (unsigned int c = 0; c < 4; ++c)
      g_bar[c] += -p_sum * lambda.V[c] - lambda_p_sum * w.V[c] +
                  quarter * (w.P[c] * lambda.beta + lambda.P[c] * w.beta);

    const double scalar =
      viscous - p_sum * divergence(geometry, lambda.V) - lambda_p_sum * divergence(geometry, w.V) +
      quarter *
        (lambda.beta * pressure_gradient(geometry, w.P) + w.beta * pressure_gradient(geometry, lambda.P));
    reverse_cell_geometry(geometry, scalar / geometry.volume, g_bar, bar.X);
    return bar;
  }

  CellSensitivity reverse_cell_dissipation(const CellGeometry<double> &geometry,
                                           const CellValues<double>   &w,
                                           const MaterialLaw<double>  &law,
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
      const double factor = quarter * law(eps2);
      const double slope  = law.slope(eps2);
      for (unsigned int k = 0; k < 6; ++k)
        E[a][k] = factor * 2. * (1. + slope * eps2) * rates.eps[a][k];
      add(E_sum, 1., E[a]);
      power += factor * eps2;
      law.reverse(eps2, factor * eps2, bar.law);
    }
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
} // namespace retroforge
