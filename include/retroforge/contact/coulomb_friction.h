// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/tresca_friction.h>

namespace retroforge
{
  /// Friction after Coulomb, limited by Tresca's:  tau = -min(mu p, m k) dv/r,  r = sqrt(|dv|^2 + v0^2), with
  /// p the pressure of the die, k as in TrescaFriction and m the die's shear limit. The minimum is smooth,
  ///   min(a, b) = (a^-n + b^-n)^(-1/n),  n = 4:
  /// 1.5 % below mu p where that is half the limit, 16 % below both where they are equal. It follows the normal
  /// force, and has no potential.
  class CoulombFriction : public InterfaceLawOf<CoulombFriction>
  {
  public:
    NumberInfo                coefficient() const override { return {"mu", "", true}; }
    std::optional<NumberInfo> limit() const override { return NumberInfo{"shear limit", "", false, 1.}; }
    bool                      has_potential() const override { return false; }
    bool                      follows_rate() const override { return true; }

    template <typename Number>
    Number compute_factor(const SlidingPoint<Number> &point) const
    {
      if (!(value_of(point.pressure) > 0.))
        return Number(0.);
      return point.area * traction(point) * ConstantTraction::factor(point);
    }

    double slip_slope(const SlidingPoint<double> &point) const override
    {
      return -1. / ConstantTraction::r2(point);
    }

    double pressure_slope(const SlidingPoint<double> &point) const override
    {
      return point.pressure > 0. ? compute_factor(point) * parts(point).of_pressure / point.pressure : 0.;
    }

    void reverse(const SlidingPoint<double> &point, const double log_bar, SlidingBar &bar) const override
    {
      if (!(point.pressure > 0.))
        return;
      const auto [of_pressure, of_shear] = parts(point);
      bar.coefficient += log_bar * of_pressure / point.coefficient;
      bar.limit += log_bar * of_shear / point.limit;
      bar.rate2 += point.metal.reverse_shear_stress(point.rate2, log_bar * of_shear, bar.metal);
      ConstantTraction::reverse(point, log_bar, bar);
    }

  private:
    static constexpr double n = 4.;

    /// By the smaller of the two, so that no power overflows.
    template <typename Number>
    static Number traction(const SlidingPoint<Number> &point)
    {
      const Number by_pressure = point.coefficient * point.pressure,
                   by_shear    = point.limit * point.metal.shear_stress(point.rate2);
      const bool   slides      = value_of(by_pressure) < value_of(by_shear);
      const Number least = slides ? by_pressure : by_shear, most = slides ? by_shear : by_pressure;
      return least * power(Number(1. + power(Number(least / most), Number(n))), Number(-1. / n));
    }

    /// Derivatives of log(tau) in the logarithms of mu p and of m k; their sum is 1.
    struct Parts
    {
      double of_pressure, of_shear;
    };
    static Parts parts(const SlidingPoint<double> &point)
    {
      const double of_pressure = std::pow(traction(point) / (point.coefficient * point.pressure), n);
      return {of_pressure, 1. - of_pressure};
    }
  };
} // namespace retroforge
