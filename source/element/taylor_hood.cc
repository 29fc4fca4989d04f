// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/element/taylor_hood.templates.h>

namespace retroforge
{
  namespace
  {
    /// g_bar of a function of the rates: eps_bar meets  eps_q = sym(sum_c U[c][q] (x) g_c).
    void add_gradient_pullback(const PointRates<double>          &eps_bar,
                               const Four<Four<Vector3<double>>> &U,
                               Four<Vec3>                        &g_bar)
    {
      for (unsigned int c = 0; c < 4; ++c)
        for (unsigned int q = 0; q < 4; ++q)
          g_bar[c] += times(eps_bar[q], U[c][q]);
    }
  } // namespace

#define RETROFORGE_INSTANTIATE(Number)                                                                         \
  template Number cell_functional(                                                                             \
    const CellGeometry<Number> &, const TaylorHoodValues<Number> &, const MaterialLaw<Number> &);              \
  template TaylorHoodValues<Number> cell_residual(                                                             \
    const CellGeometry<Number> &, const TaylorHoodValues<Number> &, const MaterialLaw<Number> &);              \
  template Number cell_dissipation(                                                                            \
    const CellGeometry<Number> &, const TaylorHoodValues<Number> &, const MaterialLaw<Number> &);              \
  template Number            cell_strain_rate(const CellGeometry<Number> &, const TaylorHoodValues<Number> &); \
  template Symmetric<Number> cell_deviatoric_stress(                                                           \
    const CellGeometry<Number> &, const TaylorHoodValues<Number> &, const MaterialLaw<Number> &);
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE

  Four<double> cell_strain_rates(const CellGeometry<double> &geometry, const TaylorHoodValues<double> &w)
  {
    return equivalent_rates(TaylorHoodRates<double>(geometry, w.V).eps);
  }

  void reverse_cell_strain_rate(const CellGeometry<double>     &geometry,
                                const TaylorHoodValues<double> &w,
                                const double                    weight,
                                TaylorHoodValues<double>       &w_bar,
                                Four<Vec3>                     &X_bar)
  {
    const TaylorHoodRates<double> rates(geometry, w.V);
    const PointRates<double>      eps_bar = reverse_mean_equivalent_rate(rates.eps, weight);
    Four<Vec3>                    g_bar   = {};
    add_velocity_pullback(geometry, eps_bar, w_bar.V);
    add_gradient_pullback(eps_bar, rates.U, g_bar);
    reverse_cell_geometry(geometry, 0., g_bar, X_bar);
  }

  CellSensitivity reverse_cell_deviatoric_stress(const CellGeometry<double>     &geometry,
                                                 const TaylorHoodValues<double> &w,
                                                 const MaterialLaw<double>      &law,
                                                 const Symmetric<double>        &s_bar,
                                                 TaylorHoodValues<double>       &w_bar)
  {
    const TaylorHoodRates<double> rates(geometry, w.V);
    CellSensitivity               bar;
    const PointRates<double>      eps_bar = reverse_mean_deviatoric_stress(rates.eps, law, s_bar, bar.law);
    Four<Vec3>                    g_bar   = {};
    add_velocity_pullback(geometry, eps_bar, w_bar.V);
    add_gradient_pullback(eps_bar, rates.U, g_bar);
    reverse_cell_geometry(geometry, 0., g_bar, bar.X);
    return bar;
  }

  CellSensitivity reverse_cell_residual(const CellGeometry<double>     &geometry,
                                        const TaylorHoodValues<double> &w,
                                        const TaylorHoodValues<double> &lambda,
                                        const MaterialLaw<double>      &law)
  {
    const double                  quarter = 0.25 * geometry.volume;
    const TaylorHoodRates<double> rates(geometry, w.V), lambda_rates(geometry, lambda.V);
    CellSensitivity               bar;
    StressPower power = reverse_stress_power(rates.eps, lambda_rates.eps, law, quarter, bar.law);
    const auto  p = at_points(w.P), lambda_p = at_points(lambda.P);
    double      value = power.value;
    for (unsigned int q = 0; q < 4; ++q)
      value -= quarter * (p[q] * trace(lambda_rates.eps[q]) + lambda_p[q] * trace(rates.eps[q]));
    add_pressures(lambda.P, -quarter, power.eps_bar);
    add_pressures(w.P, -quarter, power.eta_bar);

    Four<Vec3> g_bar = {};
    add_gradient_pullback(power.eps_bar, rates.U, g_bar);
    add_gradient_pullback(power.eta_bar, lambda_rates.U, g_bar);
    reverse_cell_geometry(geometry, value / geometry.volume, g_bar, bar.X);
    return bar;
  }

  CellSensitivity reverse_cell_dissipation(const CellGeometry<double>     &geometry,
                                           const TaylorHoodValues<double> &w,
                                           const MaterialLaw<double>      &law,
                                           const double                    weight,
                                           TaylorHoodValues<double>       &w_bar)
  {
    const TaylorHoodRates<double> rates(geometry, w.V);
    CellSensitivity               bar;
    const PointDissipation        dissipation =
      reverse_dissipation(rates.eps, law, 0.25 * geometry.volume * weight, bar.law);
    Four<Vec3> g_bar = {};
    add_velocity_pullback(geometry, dissipation.eps_bar, w_bar.V);
    add_gradient_pullback(dissipation.eps_bar, rates.U, g_bar);
    reverse_cell_geometry(geometry, dissipation.value / geometry.volume, g_bar, bar.X);
    return bar;
  }
} // namespace retroforge
