// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/interface_law.h>

#include <cmath>

namespace retroforge
{
  /// Friction after Coulomb:  tau = -mu p dv / sqrt(|dv|^2 + v0^2),  p the pressure of the die. It follows
  /// the normal force, and has no potential.
  class CoulombFriction : public InterfaceLawOf<CoulombFriction>
  {
  public:
    NumberInfo coefficient() const override { return {"mu", "", true}; }
    bool       has_potential() const override { return false; }

    template <typename Number>
    Number compute_factor(const SlidingPoint<Number> &point) const
    {
      using std::sqrt;
      if (!(value_of(point.pressure) > 0.))
        return Number(0.);
      return point.area * point.coefficient * point.pressure / sqrt(Number(r(point)));
    }

    double slip_slope(const SlidingPoint<double> &point) const override { return -1. / r(point); }

    double pressure_slope(const SlidingPoint<double> &point) const override
    {
      return point.pressure > 0. ? point.area * point.coefficient / std::sqrt(r(point)) : 0.;
    }

    void reverse(const SlidingPoint<double> &point, const double log_bar, SlidingBar &bar) const override
    {
      bar.coefficient += log_bar / point.coefficient;
      bar.contact.v0 -= log_bar * point.contact.v0 / r(point);
    }

  private:
    template <typename Number>
    static Number r(const SlidingPoint<Number> &point)
    {
      return point.slip2 + point.contact.v0 * point.contact.v0;
    }
  };

  /// Makes the law known as `Coulomb`, and returns its number.
  inline unsigned int add_coulomb_friction()
  {
    add_interface_law("Coulomb", std::make_unique<CoulombFriction>());
    return find_interface_law("Coulomb", "test");
  }
} // namespace retroforge
