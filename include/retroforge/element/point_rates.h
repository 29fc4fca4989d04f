// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/element/cell_geometry.h>

/// @file
/// Strain rates at the four points of a cell that stand for a quarter of its volume each, and what a law
/// makes of them: what elements share that differ in how their unknowns lead to these rates.
namespace retroforge
{
  /// Components xx, yy, zz, yz, xz, xy of a symmetric tensor.
  template <typename Number>
  using Symmetric = std::array<Number, 6>;

  /// Strain rates, stresses, or derivatives in them, at the four points of a cell.
  template <typename Number>
  using PointRates = Four<Symmetric<Number>>;

  /// e += sym(v (x) g)
  template <typename Number>
  void add_dyad(const Vector3<Number> &v, const Vector3<Number> &g, Symmetric<Number> &e)
  {
    e[0] += v[0] * g[0];
    e[1] += v[1] * g[1];
    e[2] += v[2] * g[2];
    e[3] += 0.5 * (v[1] * g[2] + v[2] * g[1]);
    e[4] += 0.5 * (v[0] * g[2] + v[2] * g[0]);
    e[5] += 0.5 * (v[0] * g[1] + v[1] * g[0]);
  }

  template <typename Number>
  Number double_contraction(const Symmetric<Number> &a, const Symmetric<Number> &b)
  {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2. * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
  }

  template <typename Number>
  Number trace(const Symmetric<Number> &e)
  {
    return e[0] + e[1] + e[2];
  }

  /// Subtracts the mean of the diagonal.
  template <typename Number>
  void remove_trace(Symmetric<Number> &e)
  {
    const Number mean = trace(e) / 3.;
    for (unsigned int k = 0; k < 3; ++k)
      e[k] -= mean;
  }

  template <typename Number>
  Vector3<Number> times(const Symmetric<Number> &e, const Vector3<Number> &v)
  {
    Vector3<Number> y;
    y[0] = e[0] * v[0] + e[5] * v[1] + e[4] * v[2];
    y[1] = e[5] * v[0] + e[1] * v[1] + e[3] * v[2];
    y[2] = e[4] * v[0] + e[3] * v[1] + e[2] * v[2];
    return y;
  }

  template <typename Number>
  Symmetric<Number> sum(const PointRates<Number> &rates)
  {
    Symmetric<Number> total;
    total.fill(Number(0.));
    for (const auto &e : rates)
      for (unsigned int k = 0; k < 6; ++k)
        total[k] += e[k];
    return total;
  }

  /// Sum of the law's potential  K/(m+1) chi^((m+1)/2)  [mJ/s/mm^3] over the points.
  template <typename Number>
  Number potential_sum(const PointRates<Number> &eps, const MaterialLaw<Number> &law)
  {
    Number total(0.);
    for (const auto &e : eps)
    {
      const Number eps2 = double_contraction(e, e);
      total += law(eps2) * law.potential_ratio(eps2);
    }
    return total;
  }

  /// Sum of  s:eps  [mJ/s/mm^3] over the points.
  template <typename Number>
  Number dissipation_sum(const PointRates<Number> &eps, const MaterialLaw<Number> &law)
  {
    Number total(0.);
    for (const auto &e : eps)
    {
      const Number eps2 = double_contraction(e, e);
      total += law(eps2) * eps2;
    }
    return total;
  }

  /// weight * s  at each point; s [MPa].
  template <typename Number>
  PointRates<Number>
  stresses(const PointRates<Number> &eps, const MaterialLaw<Number> &law, const Number &weight)
  {
    PointRates<Number> s;
    for (unsigned int a = 0; a < 4; ++a)
    {
      const Number factor = weight * law(double_contraction(eps[a], eps[a]));
      for (unsigned int k = 0; k < 6; ++k)
        s[a][k] = factor * eps[a][k];
    }
    return s;
  }

  /// Equivalent strain rate e = sqrt(2/3 eps:eps) [1/s]; at rest zero with zero derivative, where sqrt alone
  /// would give 0/0.
  template <typename Number>
  Number equivalent(const Symmetric<Number> &eps)
  {
    using std::sqrt;
    const Number square = 2. / 3. * double_contraction(eps, eps);
    return value_of(square) > 0. ? Number(sqrt(square)) : Number(0.);
  }

  template <typename Number>
  Four<Number> equivalent_rates(const PointRates<Number> &eps)
  {
    return {{equivalent(eps[0]), equivalent(eps[1]), equivalent(eps[2]), equivalent(eps[3])}};
  }

  /// 1/4 sum_a e_a  [1/s]
  template <typename Number>
  Number mean_equivalent_rate(const PointRates<Number> &eps)
  {
    Number total(0.);
    for (const auto &e : eps)
      total += equivalent(e);
    return 0.25 * total;
  }

  /// Derivative of weight * mean_equivalent_rate in eps; zero at points at rest.
  PointRates<double> reverse_mean_equivalent_rate(const PointRates<double> &eps, double weight);

  /// Mean of the points' stresses without the trace that is left where the discrete flow is not quite
  /// incompressible [MPa]. Points at rest have none, and no derivative: the factor of a law without e0 is
  /// infinite there.
  template <typename Number>
  Symmetric<Number> mean_deviatoric_stress(const PointRates<Number> &eps, const MaterialLaw<Number> &law)
  {
    Symmetric<Number> s;
    s.fill(Number(0.));
    for (const auto &e : eps)
    {
      const Number eps2 = double_contraction(e, e);
      if (value_of(eps2) == 0.)
        continue;
      const Number factor = 0.25 * law(eps2);
      for (unsigned int k = 0; k < 6; ++k)
        s[k] += factor * e[k];
    }
    remove_trace(s);
    return s;
  }

  /// Derivatives of  s_bar : mean_deviatoric_stress  in eps.
  /// @param law_bar  the derivatives in the law's numbers are added to it
  PointRates<double> reverse_mean_deviatoric_stress(const PointRates<double>  &eps,
                                                    const MaterialLaw<double> &law,
                                                    Symmetric<double>          s_bar,
                                                    MaterialLaw<double>       &law_bar);

  /// weight * sum of s(eps):eta over the points, with its derivatives.
  struct StressPower
  {
    double             value = 0.;
    PointRates<double> eps_bar, eta_bar; ///< eta_bar = weight * s
  };

  /// @param law_bar  the derivatives in the law's numbers are added to it
  StressPower reverse_stress_power(const PointRates<double>  &eps,
                                   const PointRates<double>  &eta,
                                   const MaterialLaw<double> &law,
                                   double                     weight,
                                   MaterialLaw<double>       &law_bar);

  /// weight * dissipation_sum, with its derivative in eps.
  struct PointDissipation
  {
    double             value = 0.;
    PointRates<double> eps_bar;
  };

  /// @param law_bar  the derivatives in the law's numbers are added to it
  PointDissipation reverse_dissipation(const PointRates<double>  &eps,
                                       const MaterialLaw<double> &law,
                                       double                     weight,
                                       MaterialLaw<double>       &law_bar);
} // namespace retroforge
