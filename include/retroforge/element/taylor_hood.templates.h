// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/element/cell_geometry.templates.h>
#include <retroforge/element/taylor_hood.h>

namespace retroforge
{
  /// The velocity node in the middle between two corners, or at the one that both are.
  inline constexpr unsigned int node_between[4][4] = {{0, 4, 6, 7}, {4, 1, 5, 8}, {6, 5, 2, 9}, {7, 8, 9, 3}};

  /// Barycentric coordinate of point q that belongs to corner q, and each of the other three.
  inline constexpr double sqrt_5            = 2.23606797749978969641;
  inline constexpr double point_lambda_own  = (5. + 3. * sqrt_5) / 20.;
  inline constexpr double point_lambda_else = (5. - sqrt_5) / 20.;

  /// At the points, what is linear with these values at the corners. The matrix is symmetric: so the
  /// pull-back of values at the points to the corners, too.
  template <typename T, typename Number = T>
  Four<T> at_points(const Four<T> &corners)
  {
    const T rest = (corners[0] + corners[1] + corners[2] + corners[3]) * Number(point_lambda_else);
    Four<T> values;
    for (unsigned int q = 0; q < 4; ++q)
      values[q] = rest + corners[q] * Number(point_lambda_own - point_lambda_else);
    return values;
  }

  /// The velocity gradients at the points:  L_q = sum_c U[c][q] (x) g_c,  and their symmetric parts.
  template <typename Number>
  struct TaylorHoodRates
  {
    Four<Four<Vector3<Number>>> U; ///< velocity of corner c at point q [mm/s]
    PointRates<Number>          eps;

    TaylorHoodRates(const CellGeometry<Number> &geometry, const VelocityNodes<Vector3<Number>> &V)
    {
      for (auto &e : eps)
        e.fill(Number(0.));
      for (unsigned int c = 0; c < 4; ++c)
      {
        Four<Vector3<Number>> W;
        for (unsigned int d = 0; d < 4; ++d)
          W[d] = V[node_between[c][d]] * Number(4.);
        U[c] = at_points<Vector3<Number>, Number>(W);
        for (unsigned int q = 0; q < 4; ++q)
        {
          U[c][q] -= V[c];
          add_dyad(U[c][q], geometry.g[c], eps[q]);
        }
      }
    }
  };

  /// Pull-back of rates: adds to V_bar the derivatives of  sum_q S_q : eps_q.
  template <typename Number>
  void add_velocity_pullback(const CellGeometry<Number>     &geometry,
                             const PointRates<Number>       &S,
                             VelocityNodes<Vector3<Number>> &V_bar)
  {
    for (unsigned int c = 0; c < 4; ++c)
    {
      Four<Vector3<Number>> U_bar;
      for (unsigned int q = 0; q < 4; ++q)
      {
        U_bar[q] = times(S[q], geometry.g[c]);
        V_bar[c] -= U_bar[q];
      }
      const auto W_bar = at_points<Vector3<Number>, Number>(U_bar);
      for (unsigned int d = 0; d < 4; ++d)
        V_bar[node_between[c][d]] += W_bar[d] * Number(4.);
    }
  }

  template <typename Number>
  Four<Number> divergences(const PointRates<Number> &eps)
  {
    return {{trace(eps[0]), trace(eps[1]), trace(eps[2]), trace(eps[3])}};
  }

  /// S_q += scale p_q I
  template <typename Number>
  void add_pressures(const Four<Number> &P, const Number &scale, PointRates<Number> &S)
  {
    const Four<Number> p = at_points(P);
    for (unsigned int q = 0; q < 4; ++q)
      for (unsigned int i = 0; i < 3; ++i)
        S[q][i] += scale * p[q];
  }

  template <typename Number>
  Number cell_functional(const CellGeometry<Number>     &geometry,
                         const TaylorHoodValues<Number> &w,
                         const MaterialLaw<Number>      &law)
  {
    const TaylorHoodRates<Number> rates(geometry, w.V);
    const Four<Number>            p   = at_points(w.P);
    Number                        sum = potential_sum(rates.eps, law);
    for (unsigned int q = 0; q < 4; ++q)
      sum -= p[q] * trace(rates.eps[q]);
    return 0.25 * geometry.volume * sum;
  }

  template <typename Number>
  TaylorHoodValues<Number> cell_residual(const CellGeometry<Number>     &geometry,
                                         const TaylorHoodValues<Number> &w,
                                         const MaterialLaw<Number>      &law)
  {
    const Number                  quarter = 0.25 * geometry.volume;
    const TaylorHoodRates<Number> rates(geometry, w.V);
    PointRates<Number>            S = stresses(rates.eps, law, quarter);
    add_pressures(w.P, Number(-quarter), S);
    TaylorHoodValues<Number> r;
    add_velocity_pullback(geometry, S, r.V);
    r.P = at_points(divergences(rates.eps));
    for (Number &p : r.P)
      p *= -quarter;
    return r;
  }

  template <typename Number>
  Number cell_dissipation(const CellGeometry<Number>     &geometry,
                          const TaylorHoodValues<Number> &w,
                          const MaterialLaw<Number>      &law)
  {
    return 0.25 * geometry.volume * dissipation_sum(TaylorHoodRates<Number>(geometry, w.V).eps, law);
  }

  template <typename Number>
  Number cell_strain_rate(const CellGeometry<Number> &geometry, const TaylorHoodValues<Number> &w)
  {
    return mean_equivalent_rate(TaylorHoodRates<Number>(geometry, w.V).eps);
  }

  template <typename Number>
  Symmetric<Number> cell_deviatoric_stress(const CellGeometry<Number>     &geometry,
                                           const TaylorHoodValues<Number> &w,
                                           const MaterialLaw<Number>      &law)
  {
    return mean_deviatoric_stress(TaylorHoodRates<Number>(geometry, w.V).eps, law);
  }
} // namespace retroforge
