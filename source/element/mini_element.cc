// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/element/mini_element.h>
#include <retroforge/element/mini_element.templates.h>

namespace retroforge
{
  namespace
  {
    /// g_bar of a strain-rate functional: eps_bar meets eps_a = sym(sum_c V_c (x) g_c + 4 beta (x) g_a).
    void add_strain_pullback(const PointRates<double> &eps_bar,
                             const Four<Vec3>         &V,
                             const Vec3               &beta,
                             Four<Vec3>               &g_bar)
    {
      const Symmetric<double> total = sum(eps_bar);
      for (unsigned int c = 0; c < 4; ++c)
        g_bar[c] += times(total, V[c]) + 4. * times(eps_bar[c], beta);
    }

    /// And the derivatives in the velocities.
    void add_unknowns_pullback(const CellGeometry<double> &geometry,
                               const PointRates<double>   &eps_bar,
                               CellValues<double>         &w_bar)
    {
      const Symmetric<double> total = sum(eps_bar);
      for (unsigned int c = 0; c < 4; ++c)
      {
        w_bar.V[c] += times(total, geometry.g[c]);
        w_bar.beta += 4. * times(eps_bar[c], geometry.g[c]);
      }
    }
  } // namespace

#define RETROFORGE_INSTANTIATE(Number)                                                                   \
  template Number cell_functional(                                                                       \
    const CellGeometry<Number> &, const CellValues<Number> &, const MaterialLaw<Number> &);              \
  template CellValues<Number> cell_residual(                                                             \
    const CellGeometry<Number> &, const CellValues<Number> &, const MaterialLaw<Number> &);              \
  template Number cell_dissipation(                                                                      \
    const CellGeometry<Number> &, const CellValues<Number> &, const MaterialLaw<Number> &);              \
  template Number            cell_strain_rate(const CellGeometry<Number> &, const CellValues<Number> &); \
  template Symmetric<Number> cell_deviatoric_stress(                                                     \
    const CellGeometry<Number> &, const CellValues<Number> &, const MaterialLaw<Number> &);
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE

  Four<double> cell_strain_rates(const CellGeometry<double> &geometry, const CellValues<double> &w)
  {
    return equivalent_rates(SubStrainRates<double>(geometry, w.V, w.beta).eps);
  }

  void reverse_cell_strain_rate(const CellGeometry<double> &geometry,
                                const CellValues<double>   &w,
                                const double                weight,
                                CellValues<double>         &w_bar,
                                Four<Vec3>                 &X_bar)
  {
    const PointRates<double> E =
      reverse_mean_equivalent_rate(SubStrainRates<double>(geometry, w.V, w.beta).eps, weight);
    add_unknowns_pullback(geometry, E, w_bar);
    Four<Vec3> g_bar = {};
    add_strain_pullback(E, w.V, w.beta, g_bar);
    reverse_cell_geometry(geometry, 0., g_bar, X_bar);
  }

  CellSensitivity reverse_cell_deviatoric_stress(const CellGeometry<double> &geometry,
                                                 const CellValues<double>   &w,
                                                 const MaterialLaw<double>  &law,
                                                 const Symmetric<double>    &s_bar,
                                                 CellValues<double>         &w_bar)
  {
    CellSensitivity          bar;
    const PointRates<double> E =
      reverse_mean_deviatoric_stress(SubStrainRates<double>(geometry, w.V, w.beta).eps, law, s_bar, bar.law);
    add_unknowns_pullback(geometry, E, w_bar);
    Four<Vec3> g_bar = {};
    add_strain_pullback(E, w.V, w.beta, g_bar);
    reverse_cell_geometry(geometry, 0., g_bar, bar.X);
    return bar;
  }

  CellSensitivity reverse_cell_residual(const CellGeometry<double> &geometry,
                                        const CellValues<double>   &w,
                                        const CellValues<double>   &lambda,
                                        const MaterialLaw<double>  &law)
  {
    const double                 quarter = 0.25 * geometry.volume;
    const SubStrainRates<double> eps(geometry, w.V, w.beta), eta(geometry, lambda.V, lambda.beta);
    CellSensitivity              bar;
    const StressPower            power = reverse_stress_power(eps.eps, eta.eps, law, quarter, bar.law);

    const double p_sum        = quarter * (w.P[0] + w.P[1] + w.P[2] + w.P[3]);
    const double lambda_p_sum = quarter * (lambda.P[0] + lambda.P[1] + lambda.P[2] + lambda.P[3]);
    Four<Vec3>   g_bar        = {};
    add_strain_pullback(power.eps_bar, w.V, w.beta, g_bar);
    add_strain_pullback(power.eta_bar, lambda.V, lambda.beta, g_bar);
    for (unsigned int c = 0; c < 4; ++c)
      g_bar[c] += -p_sum * lambda.V[c] - lambda_p_sum * w.V[c] +
                  quarter * (w.P[c] * lambda.beta + lambda.P[c] * w.beta);

    const double scalar =
      power.value - p_sum * divergence(geometry, lambda.V) - lambda_p_sum * divergence(geometry, w.V) +
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
    const SubStrainRates<double> rates(geometry, w.V, w.beta);
    CellSensitivity              bar;
    const PointDissipation       dissipation =
      reverse_dissipation(rates.eps, law, 0.25 * geometry.volume * weight, bar.law);
    add_unknowns_pullback(geometry, dissipation.eps_bar, w_bar);
    Four<Vec3> g_bar = {};
    add_strain_pullback(dissipation.eps_bar, w.V, w.beta, g_bar);
    reverse_cell_geometry(geometry, dissipation.value / geometry.volume, g_bar, bar.X);
    return bar;
  }
} // namespace retroforge
