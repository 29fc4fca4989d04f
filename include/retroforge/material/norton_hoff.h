// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/dual.h>

#include <deal.II/base/parameter_handler.h>

namespace retroforge
{
  /// Norton-Hoff law  s = 2 K q^((m-1)/2) eps,  q = 2 eps:eps + 3 e0^2 = 3 (e^2 + e0^2),  e^2 = 2/3 eps:eps.
  /// It derives from the potential  K/(m+1) q^((m+1)/2).  @cite Laroussi2003, Eq. (18), regularised by e0.
  template <typename Number>
  struct NortonHoff
  {
    Number K  = 1.; ///< consistency [MPa s^m]
    Number m  = 1.; ///< strain-rate sensitivity, in (0, 1], dimensionless
    Number e0 = 0.; ///< strain rate of the regularisation [1/s]

    /// q for  eps2 = eps:eps  [1/s^2].
    Number q(const Number &eps2) const { return 2. * eps2 + 3. * e0 * e0; }

    /// Factor  2 K q^((m-1)/2)  of  s = factor * eps  [MPa s].
    Number stress_factor(const Number &q) const { return 2. * K * power(q, Number(0.5 * (m - 1.))); }

    /// Potential K/(m+1) q^((m+1)/2)  [MPa/s].
    Number potential(const Number &q) const { return K / (m + 1.) * power(q, Number(0.5 * (m + 1.))); }
  };

  struct MaterialParameters
  {
    double consistency         = 1.693;
    double sensitivity         = 0.139;
    double minimal_strain_rate = 1e-3;

    void add_parameters(dealii::ParameterHandler &prm);
    void check() const;

    NortonHoff<double> law() const { return {consistency, sensitivity, minimal_strain_rate}; }
  };
} // namespace retroforge
