// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/element/mini_element.h>

namespace retroforge
{
  /// Symmetric strain rates of the four sub-tetrahedra, components xx, yy, zz, yz, xz, xy.
  template <typename Number>
  struct SubStrainRates
  {
    Four<std::array<Number, 6>> eps;

    SubStrainRates(const CellGeometry<Number>  &geometry,
                   const Four<Vector3<Number>> &V,
                   const Vector3<Number>       &beta)
    {
      std::array<Number, 6> linear;
      linear.fill(Number(0.));
      for (unsigned int c = 0; c < 4; ++c)
        add_dyad(V[c], geometry.g[c], linear);
      for (unsigned int a = 0; a < 4; ++a)
      {
        eps[a] = linear;
        add_dyad(Vector3<Number>(beta * Number(4.)), geometry.g[a], eps[a]);
      }
    }

    static void add_dyad(const Vector3<Number> &v, const Vector3<Number> &g, std::array<Number, 6> &e)
    {
      e[0] += v[0] * g[0];
      e[1] += v[1] * g[1];
      e[2] += v[2] * g[2];
      e[3] += 0.5 * (v[1] * g[2] + v[2] * g[1]);
      e[4] += 0.5 * (v[0] * g[2] + v[2] * g[0]);
      e[5] += 0.5 * (v[0] * g[1] + v[1] * g[0]);
    }
  };

  template <typename Number>
  Number double_contraction(const std::array<Number, 6> &a, const std::array<Number, 6> &b)
  {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2. * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
  }

  template <typename Number>
  Vector3<Number> times(const std::array<Number, 6> &e, const Vector3<Number> &v)
  {
    Vector3<Number> y;
    y[0] = e[0] * v[0] + e[5] * v[1] + e[4] * v[2];
    y[1] = e[5] * v[0] + e[1] * v[1] + e[3] * v[2];
    y[2] = e[4] * v[0] + e[3] * v[1] + e[2] * v[2];
    return y;
  }

  template <typename Number>
  CellGeometry<Number> cell_geometry(const Four<Vector3<Number>> &X)
  {
    const Vector3<Number> a = X[1] - X[0], b = X[2] - X[0], c = X[3] - X[0];
    const Vector3<Number> bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
    const Number          det = a * bc;
    CellGeometry<Number>  geometry;
    geometry.volume = det / 6.;
    geometry.g[1]   = bc / det;
    geometry.g[2]   = ca / det;
    geometry.g[3]   = ab / det;
    geometry.g[0]   = -(geometry.g[1] + geometry.g[2] + geometry.g[3]);
    return geometry;
  }

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
    Number                       potential(0.);
    for (const auto &eps : rates.eps)
    {
      const Number eps2 = double_contraction(eps, eps);
      potential += law(eps2) * law.potential_ratio(eps2);
    }
    const Number p_mean = 0.25 * (w.P[0] + w.P[1] + w.P[2] + w.P[3]);
    const Number bubble = w.beta * pressure_gradient(geometry, w.P);
    return geometry.volume * (0.25 * potential - p_mean * divergence(geometry, w.V) + 0.25 * bubble);
  }

  template <typename Number>
  CellValues<Number> cell_residual(const CellGeometry<Number> &geometry,
                                   const CellValues<Number>   &w,
                                   const MaterialLaw<Number>  &law)
  {
    const Number                 quarter = 0.25 * geometry.volume;
    const SubStrainRates<Number> rates(geometry, w.V, w.beta);
    CellValues<Number>           r;
    r.beta = pressure_gradient(geometry, w.P) * quarter;
    std::array<Number, 6> stress_sum;
    stress_sum.fill(Number(0.));
    for (unsigned int a = 0; a < 4; ++a)
    {
      const Number          factor = quarter * law(double_contraction(rates.eps[a], rates.eps[a]));
      std::array<Number, 6> s;
      for (unsigned int k = 0; k < 6; ++k)
      {
        s[k] = factor * rates.eps[a][k];
        stress_sum[k] += s[k];
      }
      r.beta += times(s, geometry.g[a]) * Number(4.);
    }
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
    const SubStrainRates<Number> rates(geometry, w.V, w.beta);
    Number                       power(0.);
    for (const auto &eps : rates.eps)
    {
      const Number eps2 = double_contraction(eps, eps);
      power += law(eps2) * eps2;
    }
    return 0.25 * geometry.volume * power;
  }
} // namespace retroforge
