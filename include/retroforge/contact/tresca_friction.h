// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/interface_law.h>

#include <cmath>

namespace retroforge
{
  /// Parts of the speed of slip, for laws whose traction does not grow with it:  tau dv / r,
  /// r = sqrt(|dv|^2 + v0^2).
  struct ConstantTraction
  {
    template <typename Number>
    static Number r2(const SlidingPoint<Number> &point)
    {
      return point.slip2 + point.contact.v0 * point.contact.v0;
    }

    /// 1/r
    template <typename Number>
    static Number factor(const SlidingPoint<Number> &point)
    {
      using std::sqrt;
      return 1. / sqrt(r2(point));
    }

    /// Adds the derivative in v0 of a scalar whose derivative in log(factor) is given.
    static void reverse(const SlidingPoint<double> &point, const double log_bar, SlidingBar &bar)
    {
      bar.contact.v0 -= log_bar * point.contact.v0 / r2(point);
    }
  };

  /// Friction after Tresca:  tau = -m k dv/r,  r = sqrt(|dv|^2 + v0^2),  k = sigma_0/sqrt(3) the shear flow
  /// stress of the metal at the point, at its frozen strain rate: a part m of what shears the metal, 1 sticks.
  class TrescaFriction : public InterfaceLawOf<TrescaFriction>
  {
  public:
    NumberInfo coefficient() const override { return {"shear factor", "", true, 1.}; }
    bool       has_potential() const override { return true; }
    bool       follows_rate() const override { return true; }

    template <typename Number>
    Number compute_factor(const SlidingPoint<Number> &point) const
    {
      return point.area * point.coefficient * point.metal.shear_stress(point.rate2) *
             ConstantTraction::factor(point);
    }

    double slip_slope(const SlidingPoint<double> &point) const override
    {
      return -1. / ConstantTraction::r2(point);
    }

    double potential_ratio(const SlidingPoint<double> &point) const override
    {
      return ConstantTraction::r2(point);
    }

    void reverse(const SlidingPoint<double> &point, const double log_bar, SlidingBar &bar) const override
    {
      bar.coefficient += log_bar / point.coefficient;
      bar.rate2 += point.metal.reverse_shear_stress(point.rate2, log_bar, bar.metal);
      ConstantTraction::reverse(point, log_bar, bar);
    }
  };
} // namespace retroforge
