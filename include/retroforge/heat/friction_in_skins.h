// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/heat/node_skins.h>

/// @file
/// Heat that friction makes between metal and die, in their skins: of its flux q_f the part f goes into the metal, and the
/// rest into the die, on either side of the film. With  1/b = 1/b_m + 1/b_d,  p = b/b_m,
///   dD_j/dt = -lambda_j D_j + h/b beta_j (DeltaT + sigma - sum D),    sigma = q_f/h (1 - f - p),
/// so that friction is a further difference for the drops of both together; and of these
///   M = mu M + p (D - mu D) - e kappa,    N = mu N + (1 - p) (D - mu D) + e kappa,    e = q_f/(b_m + b_d),
/// kappa what a flux of one per effusivity makes where nothing else flows. Beneath a film without resistance e kappa is
/// the rise of both surfaces.
namespace retroforge
{
  /// What friction makes of a node's skins over a time.
  template <typename Number>
  struct FrictionInSkins
  {
    Number           difference; ///< sigma [K]
    Number           rise;       ///< e [K/sqrt(s)]
    SkinStep<Number> unit;       ///< kappa [sqrt(s)]

    /// What the shift of the temperature behind the film has of it.
    /// @param drops, shown  1 + R and rho of the film
    /// @param source        mean of what comes, per degree
    /// @param part          p
    Number shift(const Number       &drops,
                 const Skin<Number> &shown,
                 const Skin<Number> &source,
                 const Number       &part) const
    {
      return difference * (drops * drop_of(source) - part * (shown * source)) + rise * (shown * unit.mean);
    }
  };

  /// @param film  h_c > 0
  /// @param flux  q_f [mW/mm^2]
  /// @param left  of modes where nothing flows, over the time
  template <typename Number>
  FrictionInSkins<Number> friction_in_skins(const HeatLaw<Number>  &law,
                                            const Number           &film,
                                            const Number           &flux,
                                            const Number           &time,
                                            const SkinStep<Number> &left)
  {
    FrictionInSkins<Number> made{flux / film * (1. - law.friction_part - metals_part(law)),
                                 flux / (metals_effusivity(law) + law.die_effusivity),
                                 {}};
    for (unsigned int j = 0; j < n_skin_modes; ++j)
    {
      made.unit.after[j] = skin_weights[j] * time * left.mean[j];
      made.unit.mean[j]  = skin_weights[j] / skin_rates[j] * (1. - left.mean[j]);
    }
    return made;
  }

  /// Derivatives in the numbers that friction_in_skins() takes.
  struct FrictionInSkinsBar
  {
    double part = 0., film = 0., flux = 0., time = 0.;
  };

  /// Reverse of friction_in_skins(), of which `bar` has the derivatives: adds to the law's, and to those of what is left.
  inline FrictionInSkinsBar reverse_friction_in_skins(const HeatLaw<double>         &law,
                                                      const double                   film,
                                                      const double                   flux,
                                                      const double                   time,
                                                      const SkinStep<double>        &left,
                                                      const FrictionInSkins<double> &bar,
                                                      HeatLaw<double>               &law_bar,
                                                      SkinStep<double>              &left_bar)
  {
    FrictionInSkinsBar to;
    for (unsigned int j = 0; j < n_skin_modes; ++j)
    {
      left_bar.mean[j] += skin_weights[j] * (time * bar.unit.after[j] - bar.unit.mean[j] / skin_rates[j]);
      to.time += skin_weights[j] * left.mean[j] * bar.unit.after[j];
    }
    const double metal = metals_effusivity(law), both = metal + law.die_effusivity,
                 beyond   = 1. - law.friction_part - metals_part(law),
                 both_bar = -bar.rise * flux / (both * both);
    to.flux               = bar.difference * beyond / film + bar.rise / both;
    to.film               = -bar.difference * flux * beyond / (film * film);
    to.part               = -bar.difference * flux / film;
    law_bar.friction_part += to.part;
    law_bar.die_effusivity += both_bar;
    reverse_metals_effusivity(law, both_bar, law_bar);
    return to;
  }
} // namespace retroforge
