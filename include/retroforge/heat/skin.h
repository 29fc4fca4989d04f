// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/dual.h>

#include <deal.II/base/tensor.h>

#include <array>
#include <optional>

/// @file
/// The layer that a contact has chilled, thinner than elements: in 0.05 s a die cools 0.5 mm of steel.
///
/// The surface of a half space of effusivity b, out of which the flux q(t) goes, has dropped by
///   1/b integral q(s) / sqrt(pi (t-s)) ds,
/// whatever q does. Metal and die together are one with  1/b = 1/b_m + 1/b_d,  of which each has the drop in the
/// proportion of b/b_m and b/b_d. With six rates lambda_j and weights beta_j,  1/sqrt(pi t) = sum_j beta_j exp(-lambda_j t)
/// from 1.5 ms to 200 s, so that the drop is a sum of six that each follow an equation of their own. The state of a skin
/// are these, m_j, per degree of the difference DeltaT between core and partner: beneath a film h, with q = h (1 - sum m) DeltaT,
///   dm_j/dt = -lambda_j m_j + h/b beta_j (1 - sum_i m_i),
/// and where nothing touches, dm_j/dt = -lambda_j m_j: what a contact took spreads, and the surface is soon as warm as what is
/// beneath. Both are linear, and solved exactly.
///
/// lambda and beta have the least largest error, by least eighth powers, of 1 - sum m beneath films of 0.5 to 100 kW/(m² K), and of
/// the drop beneath a constant flux: beside the exact solution (erfc) 0.5 % of DeltaT; the same after any change of film.
namespace retroforge
{
  constexpr unsigned int n_skin_modes = 6;

  /// Drops of temperature in a skin, of metal and die together, by mode, per degree between core and partner.
  template <typename Number>
  using Skin = dealii::Tensor<1, n_skin_modes, Number>;

  constexpr std::array<double, n_skin_modes> skin_rates{
    {1309.4, 109.06, 10.300, 0.97901, 0.091539, 0.0049703}}; ///< [1/s]
  constexpr std::array<double, n_skin_modes> skin_weights{
    {41.476, 7.8809, 2.4057, 0.74098, 0.23312, 0.097214}}; ///< [1/sqrt(s)]

  /// A skin after a time, and its mean over that.
  template <typename Number>
  struct SkinStep
  {
    Skin<Number> after, mean;
  };

  /// The equation of skins beneath a film that stays as it is.
  struct SkinsBeneathFilm
  {
    using Modes = std::array<double, n_skin_modes>;

    /// @param rate  film over the effusivity of metal and die together, h/b [1/sqrt(s)], > 0
    explicit SkinsBeneathFilm(double rate);

    Modes        to_eigenvectors(const Skin<double> &m) const;
    Skin<double> from_eigenvectors(const Modes &x) const;

    double                          rate;
    Modes                           eigenvalues; ///< [1/s]
    std::array<Modes, n_skin_modes> eigenvectors;
    Modes                           source; ///< square roots of the weights, by eigenvectors
  };

  /// What a time beneath a film makes of skins: what is the same for all of them is made once.
  class SkinPropagator
  {
  public:
    /// @param film  refers to it
    /// @param time  [s], >= 0
    SkinPropagator(const SkinsBeneathFilm &film, double time);

    double time() const { return time_; }

    SkinStep<double> step(const Skin<double> &before) const;

    /// What of a step's derivatives is linear in those of the skin before.
    SkinStep<double> carried(const Skin<double> &before_dot) const;

    /// Reverse of carried(): the derivatives in the skin before.
    Skin<double> reverse_carried(const SkinStep<double> &bar) const;

    /// Returns the derivatives in rate and time.
    std::array<SkinStep<double>, 2> slopes(const Skin<double> &before) const;

  private:
    using Modes = SkinsBeneathFilm::Modes;

    /// Derivatives by eigenvectors.
    struct Slopes
    {
      std::array<Modes, n_skin_modes> after, mean;                 ///< in the rate, of what was there before
      Modes                           after_source, mean_source;   ///< in the rate, of what comes
      Modes                           mean_time, mean_source_time; ///< in the time
    };
    const Slopes &slopes() const;

    const SkinsBeneathFilm       &film_;
    double                        time_;
    Modes                         after_, mean_;               ///< parts of what was there before
    Modes                         after_source_, mean_source_; ///< what comes
    mutable std::optional<Slopes> slopes_;                     ///< made when they are asked for
  };

  /// A step on dual numbers; rate and time are those of the propagator, with their derivatives.
  SkinStep<Dual>
  skin_step(const SkinPropagator &over, const Dual &rate, const Skin<Dual> &before, const Dual &time);
  inline SkinStep<double>
  skin_step(const SkinPropagator &over, const double, const Skin<double> &before, const double)
  {
    return over.step(before);
  }

  /// Returns the parts that are left of the modes of a skin after a time without contact.
  /// @param time  [s], >= 0
  template <typename Number>
  Skin<Number> healing(const Number &time)
  {
    using std::exp;
    Skin<Number> left;
    for (unsigned int j = 0; j < n_skin_modes; ++j)
      left[j] = exp(Number(-skin_rates[j] * time));
    return left;
  }

  /// Returns the skin of which these parts are left.
  template <typename Number>
  Skin<Number> healed(Skin<Number> skin, const Skin<Number> &left)
  {
    for (unsigned int j = 0; j < n_skin_modes; ++j)
      skin[j] *= left[j];
    return skin;
  }

  /// Returns the whole drop, of 0 to 1.
  template <typename Number>
  Number drop_of(const Skin<Number> &skin)
  {
    Number sum(0.);
    for (unsigned int j = 0; j < n_skin_modes; ++j)
      sum += skin[j];
    return sum;
  }

  /// Effusivity of metal and die together.
  template <typename Number>
  Number joint_effusivity(const Number &of_metal, const Number &of_die)
  {
    return 1. / (1. / of_metal + 1. / of_die);
  }
} // namespace retroforge
