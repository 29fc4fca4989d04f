// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/contact_search.h>

#include <vector>

/// @file
/// For which parts of an increment's halves a point of the metal touches a die, from what is known at its start. Heat flows
/// at the start with the metal where it is then, and at the end likewise: were only what stands at the die then to touch,
/// the time in which a point that arrives within the increment gives heat would be 0, 1/2 or 1 of it, and temperatures of dies
/// would jump with the moment.
///
/// A point at the gap delta that comes nearer by the path p over the increment is at the gap d(x) = max(0, delta - p x) after
/// its part x. The trapezoidal rule in time touches at the start and at the end for
///   first half:   int_0^1 2 (1 - x) w(d(x)/g) dx,
///   second half:  int_0^1 2 x w(d(x)/g) dx,
/// w the ramp over the gap g across which contact fades: (1 - t)_+² and (1 - t²)_+ of a point that arrives after t = delta/p,
/// where g is short beside p. Both are smooth at delta = 0, where points stand that touch. p is the path by which the dies
/// close, times what of it the metal as it moved in the increment before leaves (RampScales). At the end, what is farther off
/// than expected, d(1), has left: the second half counts by w of what it is farther, over g.
namespace retroforge
{
  /// How far from a die metal touches it.
  struct ThermalReach
  {
    double gap;  ///< across which contact fades [mm]
    double path; ///< by which dies close over the increment that begins [mm]; 0: nothing comes nearer

    ThermalReach(const double gap, const double path = 0.) : gap(gap), path(path) {}

    /// Returns w.
    FrictionRamp fading() const
    {
      FrictionRamp ramp;
      ramp.width = gap;
      return ramp;
    }
  };

  /// The parts of an increment's halves for which a point touches a die, and the gap that is expected at its end [mm].
  template <typename Number>
  struct Arrival
  {
    Number first, second, gap;
  };

  /// The rule for all points, and its reverse.
  template <typename Number>
  class Arrivals
  {
  public:
    /// Refers to the dies' states, at the start of the increment.
    Arrivals(const ThermalReach &reach, const std::vector<DieState<Number>> &states);

    /// @param at     where the point sees the die
    /// @param metal  its velocity in the increment before; null where it is not known [mm/s]
    Arrival<Number>
    operator()(unsigned int die, const Projection<Number> &at, const Vector3<Number> *metal) const;

    /// Returns the gap from which on the point does not touch, whatever the normal [mm].
    double reach(unsigned int die, const Vector3<Number> *metal) const;

    /// Adds the derivatives of  bar * (*this)(die, at, metal); those in the metal's velocity where it is known.
    void reverse(unsigned int                   die,
                 const Projection<Number>      &at,
                 const Vector3<Number>         *metal,
                 const Arrival<double>         &bar,
                 double                        &delta_bar,
                 Vec3                          &n_bar,
                 Vec3                          &metal_bar,
                 std::vector<DieState<double>> &states_bar) const;

  private:
    const std::vector<DieState<Number>> &states_;
    const ThermalReach                   reach_;
    const FrictionRamp                   fading_;
    const RampScales<Number>             scales_;
  };
} // namespace retroforge
