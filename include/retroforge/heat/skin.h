// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/dual.h>
#include <retroforge/core/types.h>

#include <deal.II/base/tensor.h>

#include <array>
#include <optional>
#include <tuple>
#include <vector>

/// @file
/// The layer that a contact has chilled, thinner than elements: in 0.05 s a die cools 0.5 mm of steel.
///
/// The surface of a half space of effusivity b, out of which the flux q(t) goes, has dropped by
///   1/b integral q(s) / sqrt(pi (t-s)) ds,
/// whatever q does. With six rates lambda_j and weights beta_j,  1/sqrt(pi t) = sum_j beta_j exp(-lambda_j t)  from 1.5 ms
/// to 200 s, so that the drop is a sum of six that each follow an equation of their own. The state of a skin are these, M_j of
/// the metal and N_j of each die, which rises [K]:
///   dM_j/dt = -lambda_j M_j + beta_j q/b_m,    dN_j/dt = -lambda_j N_j + beta_j q/b_d.
/// Metal and the die that it touches are beneath a film h, with  q = h (DeltaT - sum D),  D = M + N,  DeltaT the
/// difference of what lies beneath either skin; with  1/b = 1/b_m + 1/b_d,
///   dD_j/dt = -lambda_j D_j + h/b beta_j (DeltaT - sum_i D_i),
/// linear, and solved exactly over a time in which DeltaT stays: of what there was, and of what DeltaT adds. Out of contact
/// q = 0: what a contact took spreads, and the surface is soon as warm as what is beneath.
///
/// lambda and beta have the least largest error, by least eighth powers, of 1 - sum D/DeltaT beneath films of 0.5 to
/// 100 kW/(m² K), and of the drop beneath a constant flux: beside the exact solution (erfc) 0.5 % of DeltaT; the same after any
/// change of film.
namespace retroforge
{
  constexpr unsigned int n_skin_modes = 6;

  /// Drops of temperature in a skin, by mode [K].
  template <typename Number>
  using Skin = dealii::Tensor<1, n_skin_modes, Number>;

  constexpr std::array<double, n_skin_modes> skin_rates{
    {1309.4, 109.06, 10.300, 0.97901, 0.091539, 0.0049703}}; ///< [1/s]
  constexpr std::array<double, n_skin_modes> skin_weights{
    {41.476, 7.8809, 2.4057, 0.74098, 0.23312, 0.097214}}; ///< [1/sqrt(s)]

  /// The skins of a workpiece, one beneath each node, and of the dies that its nodes have touched.
  template <typename Number>
  struct NodeSkins
  {
    std::vector<Skin<Number>>              metal;
    std::vector<std::vector<Skin<Number>>> dies; ///< of each, what a node has warmed; negative: chilled

    static NodeSkins none(const std::size_t n_nodes, const std::size_t n_dies)
    {
      const std::vector<Skin<Number>> of_one(n_nodes);
      return {of_one, std::vector<std::vector<Skin<Number>>>(n_dies, of_one)};
    }

    bool empty() const { return metal.empty(); }

    bool operator==(const NodeSkins &other) const { return metal == other.metal && dies == other.dies; }

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[metal, dies] = self;
      return std::tie(metal, dies);
    }
  };

  /// Skins that are kept for later: of the nodes that have one.
  class KeptSkins
  {
  public:
    KeptSkins() = default;
    explicit KeptSkins(const NodeSkins<double> &skins);

    NodeSkins<double> all() const;

  private:
    std::size_t               n_nodes_ = 0, n_dies_ = 0;
    std::vector<NodeIndex>    nodes_;
    std::vector<Skin<double>> skins_; ///< of each of these nodes the metal's, then the dies'
  };

  /// A skin after a time, and its mean over that.
  template <typename Number>
  struct SkinStep
  {
    Skin<Number> after, mean;
  };

  /// What a time beneath a film makes of a skin D: carried + DeltaT source.
  template <typename Number>
  struct SkinParts
  {
    SkinStep<Number> carried; ///< what is left of D [K]
    SkinStep<Number> source;  ///< what comes, per degree
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

    const SkinStep<double> &source() const { return source_; }

    SkinStep<double> carried(const Skin<double> &before) const;

    /// Reverse of carried(): the derivatives in the skin before.
    Skin<double> reverse_carried(const SkinStep<double> &bar) const;

    /// The derivatives in rate and time: of what comes, and of what is left.
    const std::array<SkinStep<double>, 2> &source_slopes() const { return slopes().of_source; }
    std::array<SkinStep<double>, 2>        carried_slopes(const Skin<double> &before) const;

  private:
    using Modes = SkinsBeneathFilm::Modes;

    /// Derivatives.
    struct Slopes
    {
      std::array<Modes, n_skin_modes> after, mean; ///< by eigenvectors, in the rate, of what was there before
      Modes                           mean_time;   ///< in the time
      std::array<SkinStep<double>, 2> of_source;
    };
    const Slopes &slopes() const;

    const SkinsBeneathFilm       &film_;
    double                        time_;
    Modes                         after_, mean_; ///< parts of what was there before, by eigenvectors
    SkinStep<double>              source_;
    mutable std::optional<Slopes> slopes_; ///< made when they are asked for
  };

  /// Both parts on dual numbers; rate and time are those of the propagator, with their derivatives.
  SkinParts<Dual>
  skin_parts(const SkinPropagator &over, const Dual &rate, const Skin<Dual> &before, const Dual &time);
  inline SkinParts<double>
  skin_parts(const SkinPropagator &over, const double, const Skin<double> &before, const double)
  {
    return {over.carried(before), over.source()};
  }

  /// Returns the parts that are left of the modes of a skin after a time in which nothing flows, and on its mean.
  /// @param time  [s], >= 0
  SkinStep<double> healing(double time);
  SkinStep<Dual>   healing(const Dual &time);

  /// Its derivative.
  SkinStep<double> slope_of_healing(double time);

  /// Mode by mode: the skin of which these parts are left.
  template <typename Number>
  Skin<Number> healed(Skin<Number> skin, const Skin<Number> &left)
  {
    for (unsigned int j = 0; j < n_skin_modes; ++j)
      skin[j] *= left[j];
    return skin;
  }

  /// Returns the whole drop.
  template <typename Number>
  Number drop_of(const Skin<Number> &skin)
  {
    Number sum(0.);
    for (unsigned int j = 0; j < n_skin_modes; ++j)
      sum += skin[j];
    return sum;
  }

  /// Reverse of drop_of().
  inline void add_to_modes(const double x, Skin<double> &skin)
  {
    for (unsigned int j = 0; j < n_skin_modes; ++j)
      skin[j] += x;
  }

  /// Effusivity of metal and die together.
  template <typename Number>
  Number joint_effusivity(const Number &of_metal, const Number &of_die)
  {
    return 1. / (1. / of_metal + 1. / of_die);
  }
} // namespace retroforge
