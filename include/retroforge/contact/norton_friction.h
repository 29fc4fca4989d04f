// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/interface_law.h>

namespace retroforge
{
  /// Friction after Norton:  tau = -alpha K r^((m-1)/2) dv,  r = |dv|^2 + v0^2,  with the metal's K and m.
  /// @cite Laroussi2003, Eq. (21), regularised by v0.
  class NortonFriction : public InterfaceLawOf<NortonFriction>
  {
  public:
    NumberInfo coefficient() const override { return {"alpha", "mm^(-m)", true}; }
    bool       has_potential() const override { return true; }
    bool       is_linear(const MaterialLaw<double> &metal) const override { return metal.is_linear(); }

    template <typename Number>
    Number compute_factor(const SlidingPoint<Number> &point) const
    {
      return point.area * point.coefficient * point.metal.K *
             power(r(point), Number(0.5 * (point.metal.m - 1.)));
    }

    double slip_slope(const SlidingPoint<double> &point) const override
    {
      return point.metal.m == 1. ? 0. : (point.metal.m - 1.) / r(point);
    }

    double potential_ratio(const SlidingPoint<double> &point) const override
    {
      return r(point) / (point.metal.m + 1.);
    }

    void reverse(const SlidingPoint<double> &point, const double log_bar, SlidingBar &bar) const override
    {
      bar.coefficient += log_bar / point.coefficient;
      bar.metal.K += log_bar / point.metal.K;
      bar.metal.m += log_bar * 0.5 * log_or_zero(r(point));
      bar.contact.v0 += log_bar * slip_slope(point) * point.contact.v0;
    }

    double linear_coefficient(const SlidingPoint<double> &point,
                              const MaterialLaw<double>  &linear_metal) const override
    {
      return point.coefficient *
             (std::pow(std::sqrt(point.slip2), point.metal.m - 1.) * point.metal.K / linear_metal.K);
    }

  private:
    template <typename Number>
    static Number r(const SlidingPoint<Number> &point)
    {
      return point.slip2 + point.contact.v0 * point.contact.v0;
    }
  };
} // namespace retroforge
