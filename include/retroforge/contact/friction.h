// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/material/material_law.h>

namespace retroforge
{
  /// The numbers of the contact and friction laws.
  template <typename Number>
  struct ContactLaw
  {
    Number rho = Number(0.); ///< penalty [MPa s/mm]
    Number v0  = Number(0.); ///< slip regularisation [mm/s]

    ContactLaw() = default;
    ContactLaw(const Number &rho, const Number &v0) : rho(rho), v0(v0) {}

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[rho, v0] = self;
      return std::tie(rho, v0);
    }

    static std::vector<NumberInfo> info() { return {{"rho", "MPa s/mm"}, {"v0", "mm/s", true}}; }

    /// Whether contact depends on a number, called as in info().
    static bool depends_on(const std::string &name, const bool with_friction)
    {
      return name != "v0" || with_friction;
    }
  };

  /// Friction after Norton:  tau = -alpha K r^((m-1)/2) dv,  r = |dv|^2 + v0^2,  with the metal's K and m.
  /// Contact knows it as a law  tau S^f = -factor(alpha S^f, |dv|^2) dv.  @cite Laroussi2003, Eq. (21)
  template <typename Number>
  struct NortonFriction
  {
    const MaterialLaw<Number> &metal;
    const ContactLaw<Number>  &contact;

    /// scale K r^((m-1)/2)  at  dv2 = |dv|^2.
    Number operator()(const Number &scale, const Number &dv2) const
    {
      return scale * metal.K * power(r(dv2), Number(0.5 * (metal.m - 1.)));
    }

    /// d log(factor) / d|dv| over |dv|  [s^2/mm^2].
    Number slope(const Number &dv2) const
    {
      return value_of(metal.m) == 1. ? Number(0.) : Number((metal.m - 1.) / r(dv2));
    }

    /// Potential over factor: what the potential's derivative in dv over dv gives the factor [mm^2/s^2].
    Number potential_ratio(const Number &dv2) const { return r(dv2) / (metal.m + 1.); }

    /// Adds the derivatives in the laws' numbers of a scalar whose derivative in log(factor) is `log_bar`.
    void reverse(const double         dv2,
                 const double         log_bar,
                 MaterialLaw<double> &metal_bar,
                 ContactLaw<double>  &contact_bar) const
    {
      metal_bar.K += log_bar / metal.K;
      metal_bar.m += log_bar * 0.5 * log_or_zero(r(dv2));
      contact_bar.v0 += log_bar * slope(dv2) * contact.v0;
    }

    /// What alpha is to be multiplied by for the same friction at a slip speed [mm/s] beside a linear metal.
    Number linear_part(const Number &speed, const MaterialLaw<Number> &linear_metal) const
    {
      using std::pow;
      return pow(speed, metal.m - 1.) * metal.K / linear_metal.K;
    }

  private:
    Number r(const Number &dv2) const { return dv2 + contact.v0 * contact.v0; }
  };

  /// By this name contact knows the law of friction.
  template <typename Number>
  using FrictionLaw = NortonFriction<Number>;
} // namespace retroforge
