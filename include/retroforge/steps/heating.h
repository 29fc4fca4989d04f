// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/heat/heat_flow.h>
#include <retroforge/steps/mechanics.h>

/// @file
/// Conduction as a step of an increment. Heat flows for half its time before its mechanics, between nodes and dies
/// where they are at its start, and for half of it after, where they are at its end (Strang's splitting): with a scheme
/// of second order in time, both together are of second order, and the stages of mechanics find temperatures of
/// their own time. Metal that arrives at a die in between gives heat for the part of either half that arrivals.h says.
/// Before the first increment of an operation, heat flows while the workpiece is transferred in air, and
/// while it waits on the resting die, where dies stand at its start.
namespace retroforge
{
  /// What touches dies under the press in either half of an increment.
  struct TouchedDies
  {
    ThermalSurface<double> first, second;
  };

  /// Takes temperatures and skins over the first half of an increment, and over what comes before the first one of an
  /// operation; changes nothing where heat does not flow.
  /// @param at     the increment
  /// @param state  with the velocity of the increment before; none where it is not known
  /// @return what touches dies under the press
  template <typename Number>
  ThermalSurface<Number> conduct_before(const Scene               &scene,
                                        const NetworkEdges        &edges,
                                        const Process<Number>     &process,
                                        const StrokeStep          &at,
                                        WorkpieceState<3, Number> &state);

  /// Takes them over the second half.
  /// @param start  what conduct_before() returned
  /// @param X      where the nodes are at the end
  /// @return what touches dies
  template <typename Number>
  ThermalSurface<Number> conduct_after(const ThermalSurface<Number> &start,
                                       const Scene                  &scene,
                                       const NetworkEdges           &edges,
                                       const Process<Number>        &process,
                                       const StrokeStep             &at,
                                       const NodalVectors<Number>   &X,
                                       WorkpieceState<3, Number>    &state);

  /// Returns the temperatures of the metal's surface and of that of the dies where they touch, under the press after an
  /// increment (heat/heat_flow.h) [C]; none where heat does not flow.
  std::array<std::vector<double>, 2> surface_temperatures(const Scene                     &scene,
                                                          const Process<double>           &process,
                                                          const StrokeStep                &at,
                                                          const WorkpieceState<3, double> &state);

  /// Both that remember their steps, and their reverse.
  class ReversibleConduction
  {
  public:
    /// Refers to all that it gets, and to nothing where heat does not flow.
    /// @param state     at the start of the increment
    /// @param touching  what both returned
    ReversibleConduction(const Scene                     &scene,
                         const NetworkEdges              &edges,
                         const Process<double>           &process,
                         const StrokeStep                &at,
                         const WorkpieceState<3, double> &state,
                         const TouchedDies               &touching);

    /// Reverse of conduct_after(): what of it hangs on the start of the increment is kept for reverse_before().
    /// @param X         where the nodes are at the end
    /// @param state     temperatures and skins before the second half
    /// @param costates  of those after on entry, of those before on exit; to positions and process theirs are added
    void reverse_after(const NodalVectors<double>      &X,
                       const WorkpieceState<3, double> &state,
                       std::vector<Costate>            &costates);

    /// Reverse of conduct_before(), after reverse_after(): adds to velocities, too.
    void reverse_before(std::vector<Costate> &costates) const;

  private:
    struct Steps;
    const TouchedDies             &touching_;
    std::shared_ptr<const Steps>   first_;
    std::vector<ThermalSurfaceBar> start_bars_; ///< of each costate, in what touches in the first half
  };
} // namespace retroforge
