// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/contact_law.h>

#include <optional>

namespace retroforge
{
  /// The rule by which the numbers of the contact law follow from the metal and the speed at which the dies
  /// close, also where a design changes these, and their derivatives with them. The height stays that of the
  /// nominal billet, as increments and sizes of elements do.
  struct OpenContact
  {
    double height      = 1.; ///< height of the whole billet [mm]
    double penetration = 1.; ///< speed at which a node sinks in under the mean pressure, over the dies'
    std::optional<double> penalty       = {}; ///< rho, where it is set and does not follow [MPa s/mm]
    double                slip_fraction = 0.; ///< v0 over the speed at which the dies close

    /// Returns the mean pressure of a frictionless upsetting,  p = factor(3/2 e^2) 3/2 e,  e = speed / height
    /// [MPa].
    template <typename Number>
    Number mean_pressure(const MaterialLaw<Number> &metal, const Number &speed) const
    {
      const Number rate = speed / height;
      return metal(Number(1.5 * rate * rate)) * 1.5 * rate;
    }

    /// rho = p / (penetration speed),  v0 = slip_fraction speed.
    template <typename Number>
    ContactLaw<Number> law(const MaterialLaw<Number> &metal, const Number &speed) const
    {
      const Number rho =
        penalty ? Number(*penalty) : Number(mean_pressure(metal, speed) / (penetration * speed));
      return {rho, Number(slip_fraction * speed)};
    }
  };
} // namespace retroforge
