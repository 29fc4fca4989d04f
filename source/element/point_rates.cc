// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/element/point_rates.h>

namespace retroforge
{
  PointRates<double> reverse_mean_equivalent_rate(const PointRates<double> &eps, const double weight)
  {
    PointRates<double> eps_bar;
    for (unsigned int a = 0; a < 4; ++a)
    {
      // weight/4 de_a/deps_a = weight/4 (2/3 eps_a / e_a)
      const double e      = equivalent(eps[a]);
      const double factor = e > 0. ? weight / (6. * e) : 0.;
      for (unsigned int k = 0; k < 6; ++k)
        eps_bar[a][k] = factor * eps[a][k];
    }
    return eps_bar;
  }

  PointRates<double> reverse_mean_deviatoric_stress(const PointRates<double>  &eps,
                                                    const MaterialLaw<double> &law,
                                                    Symmetric<double>          s_bar,
                                                    MaterialLaw<double>       &law_bar)
  {
    remove_trace(s_bar);
    PointRates<double> eps_bar = {};
    for (unsigned int a = 0; a < 4; ++a)
    {
      const double eps2 = double_contraction(eps[a], eps[a]);
      if (eps2 == 0.)
        continue;
      const double factor = 0.25 * law(eps2), product = double_contraction(eps[a], s_bar);
      const double slope = law.slope(eps2);
      for (unsigned int k = 0; k < 6; ++k)
        eps_bar[a][k] = factor * (s_bar[k] + 2. * slope * product * eps[a][k]);
      law.reverse(eps2, factor * product, law_bar);
    }
    return eps_bar;
  }

  StressPower reverse_stress_power(const PointRates<double>  &eps,
                                   const PointRates<double>  &eta,
                                   const MaterialLaw<double> &law,
                                   const double               weight,
                                   MaterialLaw<double>       &law_bar)
  {
    StressPower power;
    for (unsigned int a = 0; a < 4; ++a)
    {
      const double eps2    = double_contraction(eps[a], eps[a]);
      const double factor  = weight * law(eps2);
      const double product = double_contraction(eps[a], eta[a]);
      const double slope   = law.slope(eps2);
      for (unsigned int k = 0; k < 6; ++k)
      {
        power.eps_bar[a][k] = factor * (eta[a][k] + 2. * slope * product * eps[a][k]);
        power.eta_bar[a][k] = factor * eps[a][k];
      }
      power.value += factor * product;
      law.reverse(eps2, factor * product, law_bar);
    }
    return power;
  }

  PointDissipation reverse_dissipation(const PointRates<double>  &eps,
                                       const MaterialLaw<double> &law,
                                       const double               weight,
                                       MaterialLaw<double>       &law_bar)
  {
    PointDissipation dissipation;
    for (unsigned int a = 0; a < 4; ++a)
    {
      const double eps2   = double_contraction(eps[a], eps[a]);
      const double factor = weight * law(eps2);
      const double slope  = law.slope(eps2);
      for (unsigned int k = 0; k < 6; ++k)
        dissipation.eps_bar[a][k] = factor * 2. * (1. + slope * eps2) * eps[a][k];
      dissipation.value += factor * eps2;
      law.reverse(eps2, factor * eps2, law_bar);
    }
    return dissipation;
  }
} // namespace retroforge
