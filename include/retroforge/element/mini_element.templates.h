// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/element/cell_geometry.templates.h>
#include <retroforge/element/mini_element.h>
#include <retroforge/element/point_rates.h>

namespace retroforge
{
  /// Strain rates of the four sub-tetrahedra.
  template <typename Number>
  struct SubStrainRates
  {
    PointRates<Number> eps;

    SubStrainRates(const CellGeometry<Number>  &geometry,
                   const Four<Vector3<Number>> &V,
                   const Vector3<Number>       &beta)
    {
      Symmetric<Number> linear;
      linear.fill(Number(0.));
      for (unsigned int c = 0; c < 4; ++c)
        add_dyad(V[c], geometry.g[c], linear);
      for (unsigned int a = 0; a < 4; ++a)
      {
        eps[a] = linear;
        add_dyad(Vector3<Number>(beta * Number(4.)), geometry.g[a], eps[a]);
      }
    }
  };

  /// tr(L) = sum_c V_c·g_c.
  template <typename Number>
  Number divergence(const CellGeometry<Number> &geometry, const Four<Vector3<Number>> &V)
  {
    Number trace = V[0] * geometry.g[0];
    for (unsigned int c = 1; c < 4; ++c)
      trace += V[c] * geometry.g[c];
    return trace;
  }

  template <typename Number>
  Vector3<Number> pressure_gradient(const CellGeometry<Number> &geometry, const Four<Number> &P)
  {
    Vector3<Number> gradient = geometry.g[0] * P[0];
    for (unsigned int c = 1; c < 4; ++c)
      gradient += geometry.g[c] * P[c];
    return gradient;
  }

  template <typename Number>
  Number cell_functional(const CellGeometry<Number> &geometry,
                         const CellValues<Number>   &w,
                         const MaterialLaw<Number>  &law)
  {
    const SubStrainRates<Number> rates(geometry, w.V, w.beta);
    const Number                 potential = potential_sum(rates.eps, law);
    const Number                 p_mean    = 0.25 * (w.P[0] + w.P[1] + w.P[2] + w.P[3]);
    const Number                 bubble    = w.beta * pressure_gradient(geometry, w.P);
    return geometry.volume * (0.25 * potential - p_mean * divergence(geometry, w.V) + 0.25 * bubble);
  }

  template <typename Number>
  CellValues<Number> cell_residual(const CellGeometry<Number> &geometry,
                                   const CellValues<Number>   &w,
                                   const MaterialLaw<Number>  &law)
  {
    const Number                 quarter = 0.25 * geometry.volume;
    const SubStrainRates<Number> rates(geometry, w.V, w.beta);
    const PointRates<Number>     s          = stresses(rates.eps, law, quarter);
    const Symmetric<Number>      stress_sum = sum(s);
    CellValues<Number>           r;
    r.beta = pressure_gradient(geometry, w.P) * quarter;
    for (unsigned int a = 0; a < 4; ++a)
      r.beta += times(s[a], geometry.g[a]) * Number(4.);
    const Number p_sum = quarter * (w.P[0] + w.P[1] + w.P[2] + w.P[3]);
    const Number trace = divergence(geometry, w.V);
    for (unsigned int c = 0; c < 4; ++c)
    {
      r.V[c] = times(stress_sum, geometry.g[c]) - geometry.g[c] * p_sum;
      r.P[c] = quarter * (w.beta * geometry.g[c] - trace);
    }
    return r;
  }

  template <typename Number>
  Number cell_dissipation(const CellGeometry<Number> &geometry,
                          const CellValues<Number>   &w,
                          const MaterialLaw<Number>  &law)
  {
    return 0.25 * geometry.volume * dissipation_sum(SubStrainRates<Number>(geometry, w.V, w.beta).eps, law);
  }

  template <typename Number>
  Number cell_strain_rate(const CellGeometry<Number> &geometry, const CellValues<Number> &w)
  {
    return mean_equivalent_rate(SubStrainRates<Number>(geometry, w.V, w.beta).eps);
  }

  template <typename Number>
  Symmetric<Number> cell_deviatoric_stress(const CellGeometry<Number> &geometry,
                                           const CellValues<Number>   &w,
                                           const MaterialLaw<Number>  &law)
  {
    return mean_deviatoric_stress(SubStrainRates<Number>(geometry, w.V, w.beta).eps, law);
  }
} // namespace retroforge
