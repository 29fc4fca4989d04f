// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/numbers.h>

namespace retroforge
{
  /// Norton-Hoff law  s = 2 K chi^((m-1)/2) eps,  chi = 2 eps:eps + 3 e0^2 = 3 (e^2 + e0^2),
  /// e^2 = 2/3 eps:eps. It derives from the potential  K/(m+1) chi^((m+1)/2).  @cite Laroussi2003, Eq. (18),
  /// regularised by e0.
  template <typename Number>
  struct NortonHoff
  {
    Number K  = Number(0.); ///< consistency [MPa s^m]
    Number m  = Number(0.); ///< strain-rate sensitivity, in (0, 1], dimensionless
    Number e0 = Number(0.); ///< strain rate of the regularisation [1/s]

    NortonHoff() = default;
    NortonHoff(const Number &K, const Number &m, const Number &e0) : K(K), m(m), e0(e0) {}

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[K, m, e0] = self;
      return std::tie(K, m, e0);
    }

    static std::vector<NumberInfo> info()
    {
      return {{"K", "MPa s^m"}, {"m", "", false, 1.}, {"e0", "1/s", true}};
    }

    /// Returns whether the stress depends on the number with a name of info().
    bool depends_on(const std::string &name) const { return name != "e0" || !is_linear(); }

    /// Returns whether the stress is proportional to the strain rate.
    bool is_linear() const { return value_of(m) == 1.; }

    /// Factor  2 K chi^((m-1)/2)  of  s = factor * eps  [MPa s] at  eps2 = eps:eps  [1/s^2].
    Number operator()(const Number &eps2) const { return 2. * K * power(chi(eps2), Number(0.5 * (m - 1.))); }

    /// Potential over factor  chi/(2 (m+1))  [1/s^2].
    Number potential_ratio(const Number &eps2) const { return chi(eps2) / (2. * (m + 1.)); }

    /// d log(factor) / d eps2  [s^2].
    Number slope(const Number &eps2) const { return is_linear() ? Number(0.) : Number((m - 1.) / chi(eps2)); }

    /// Adds to `bar` the derivatives in K, m and e0 of a scalar whose derivative in log(factor) is `log_bar`.
    void reverse(const double eps2, const double log_bar, NortonHoff<double> &bar) const
    {
      bar.K += log_bar / K;
      bar.m += log_bar * 0.5 * log_or_zero(chi(eps2));
      bar.e0 += log_bar * slope(eps2) * 3. * e0;
    }

    /// Shear flow stress  k = sigma_0/sqrt(3) = K (3 (e^2 + e0^2))^(m/2)  [MPa] at the square of an equivalent
    /// strain rate [1/s^2]: it does not vanish where the metal is still.
    Number shear_stress(const Number &rate2) const
    {
      return K * power(Number(3. * (rate2 + e0 * e0)), Number(0.5 * m));
    }

    /// Adds to `bar` the derivatives in K, m and e0 of a scalar whose derivative in log(shear_stress) is
    /// `log_bar`, and returns that in rate2.
    double reverse_shear_stress(const double rate2, const double log_bar, NortonHoff<double> &bar) const
    {
      const double floored = rate2 + e0 * e0, slope = floored > 0. ? log_bar * 0.5 * m / floored : 0.;
      bar.K += log_bar / K;
      bar.m += log_bar * 0.5 * log_or_zero(3. * floored);
      bar.e0 += 2. * slope * e0;
      return slope;
    }

    /// The linear law with the same stress at an equivalent strain rate.
    NortonHoff newtonian(const Number &rate) const
    {
      return {K * power(Number(3. * rate * rate), Number(0.5 * (m - 1.))), Number(1.), Number(0.)};
    }

  private:
    Number chi(const Number &eps2) const { return 2. * eps2 + 3. * e0 * e0; }
  };
} // namespace retroforge
