// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/heat/conduction_step.h>
#include <retroforge/heat/friction_in_skins.h>

#include <optional>
#include <vector>

/// @file
/// The films between nodes and dies over a step in time, and what becomes of the skins beneath them.
///
/// Beneath a film h the flux is  q = h (DeltaT - sum D)  of the skins D = M + N of metal and dies (skin.h), and
///   D = P + DeltaT B
/// on the mean over the step, P what is left of it and B what comes. The node has the temperature
/// T = T_core - sum_j rho_j M_j  (node_skins.h), and DeltaT is T_core less the temperature t of the die. With p = b/b_m, the
/// mean mu_j of what is left of a mode where nothing flows, and  M = mu M + p (D - mu D)  that is linear in T,
///   q = h/(1 + R) (T - t - u),   1 + R = (1 - p sum_j rho_j B_j)/(1 - sum_j B_j),
///   u = (1 + R) sum_j P_j - sum_j rho_j (mu_j M_j + p (P_j - mu_j D_j)):
/// a conductance, as of skins that begin with the step, and a temperature t + u behind it, which is what there was before:
/// a die that is warm already, and metal that has cooled. It is kept between those of the node, of the die and of its surface.
///
/// The temperature of the node on the mean over the step gives q, q gives DeltaT, and DeltaT the skins after the step.
///
/// Friction between node and die makes heat that skins take, too (friction_in_skins.h).
///
/// A node touches for a part of the time; before, all its skins heal. Of a node that touches several dies, t and N are means
/// by area, and the skin of each die gets of q the part of the time for which it touches.
namespace retroforge
{
  /// What a step makes of times: of skins beneath the film, and of those that heal. Most nodes touch all of the time, or none.
  template <typename Number>
  class SkinsOverStep
  {
  public:
    SkinsOverStep(const HeatFlow<Number> &flow, const Number &dt);
    SkinsOverStep(const SkinsOverStep &) = delete; // the propagator refers to the film

    SkinStep<Number> healing(const Number &time) const
    {
      return value_of(time) == dt_ ? healing_ : retroforge::healing(time);
    }

    /// f(SkinPropagator) of a time that a node touches.
    template <typename F>
    auto touching(const double time, const F &f) const
    {
      return time == dt_ ? f(*whole_) : f(SkinPropagator(*film_, time));
    }

    const Number &rate() const { return rate_; } ///< h/b, of metal and die together [1/sqrt(s)]
    const Number &part() const { return part_; } ///< p

  private:
    Number                          rate_, part_;
    double                          dt_;
    SkinStep<Number>                healing_;
    std::optional<SkinsBeneathFilm> film_;
    std::optional<SkinPropagator>   whole_;
  };

  /// A node's film and skins over a step.
  template <typename Number>
  struct NodeFilm
  {
    Skin<Number>      both; ///< D
    SkinParts<Number> parts;
    SkinStep<Number>  left;   ///< of modes where nothing flows
    Skin<Number>      shown;  ///< rho
    Number            drops;  ///< 1 + R
    Number            behind; ///< t
    Number            shift;  ///< u

    std::optional<FrictionInSkins<Number>> friction; ///< where it makes heat
  };

  /// The films of all nodes.
  template <typename Number>
  class ContactSkins
  {
  public:
    /// @param T     before the step; a node's film keeps the temperature behind it between this and the die's
    /// @param skin  before the step on entry, when nodes touch on exit
    ContactSkins(const HeatFlow<Number>    &flow,
                 const Number              &dt,
                 const std::vector<Number> &T,
                 NodeSkins<Number>         &skin);

    NodeFilms<Number> films() const;

    /// Takes skins over the time in which nodes touch.
    /// @param T  with which films took their heat
    void advance(const std::vector<Number> &T, NodeSkins<Number> &skin) const;

  private:
    const HeatFlow<Number>          &flow_;
    SkinsOverStep<Number>            over_;
    std::vector<NodeContact<Number>> contacts_;
    std::vector<NodeFilm<Number>>    films_; ///< of contacts that have one

    friend class ReverseContactSkins;
  };

  /// Its reverse, in the opposite order.
  class ReverseContactSkins
  {
  public:
    /// @param T, skin  before the step
    ReverseContactSkins(const HeatFlow<double>    &flow,
                        double                     dt,
                        const std::vector<double> &T,
                        const NodeSkins<double>   &skin);

    NodeFilms<double> films() const { return contact_.films(); }

    /// Returns the derivatives in the temperatures with which films took their heat.
    /// @param skin_bar  in skins after the step
    std::vector<double> reverse_temperatures(const NodeSkins<double> &skin_bar) const;

    /// Reverse of all the rest.
    /// @param T_films    with which films took their heat
    /// @param films_bar  derivatives in films
    /// @param T_bar      gets those in the temperatures before added
    /// @param skin_bar   in skins after the step on entry, in those before on exit
    void reverse(const std::vector<double> &T_films,
                 const NodeFilms<double>   &films_bar,
                 std::vector<double>       &T_bar,
                 NodeSkins<double>         &skin_bar,
                 HeatFlowBar               &bar) const;

  private:
    const HeatFlow<double>    &flow_;
    const double               dt_;
    const std::vector<double> &T_;
    const NodeSkins<double>   &before_;
    NodeSkins<double>          skin_; ///< when nodes touch
    const ContactSkins<double> contact_;
  };
} // namespace retroforge
