// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/heat/heat_flow.h>
#include <retroforge/steps/mechanics.h>

/// @file
/// Conduction as a step of an increment. Heat flows for half its time before its mechanics, between nodes and dies
/// where they are at its start, and for half of it after, where they are at its end (Strang's splitting): with a scheme
/// of second order in time, both together are of second order, and the stages of mechanics find temperatures of
/// their own time. Before the first increment of an operation, heat flows while the workpiece is transferred in air, and
/// while it waits on the resting die, where dies stand at its start.
namespace retroforge
{
  /// Where and when of an increment heat flows: half of it, and what comes before the first one of an operation.
  enum class HalfOfIncrement
  {
    first,
    second
  };

  /// Takes temperatures and skins over half an increment; changes nothing where heat does not flow.
  /// @param X  where the nodes are: at the start, or at the end
  /// @return heat that came in through the surface [mJ]
  template <typename Number>
  Number conduct_over(HalfOfIncrement             half,
                      const Scene                &scene,
                      const NetworkEdges         &edges,
                      const Process<Number>      &process,
                      const StrokeStep           &at,
                      const NodalVectors<Number> &X,
                      WorkpieceState<3, Number>  &state);

  /// Returns the temperatures of the metal's surface and of that of the dies where they touch, under the press after an
  /// increment (heat/heat_flow.h) [C]; none where heat does not flow.
  std::array<std::vector<double>, 2> surface_temperatures(const Scene                     &scene,
                                                          const Process<double>           &process,
                                                          const StrokeStep                &at,
                                                          const WorkpieceState<3, double> &state);

  /// conduct_over() that remembers its steps, and its reverse.
  class ReversibleConduction
  {
  public:
    /// Refers to all but the state, and to nothing where heat does not flow.
    /// @param X      where the nodes are
    /// @param state  temperatures and skins before
    ReversibleConduction(HalfOfIncrement                  half,
                         const Scene                     &scene,
                         const NetworkEdges              &edges,
                         const Process<double>           &process,
                         const StrokeStep                &at,
                         const NodalVectors<double>      &X,
                         const WorkpieceState<3, double> &state);

    /// Sets temperatures and skins to those after, as conduct_over() does.
    void take(WorkpieceState<3, double> &state) const;

    /// @param costates  of those after on entry, of those before on exit; to positions and process theirs are added
    void reverse(std::vector<Costate> &costates) const;

  private:
    struct Steps;
    std::shared_ptr<const Steps> steps_;
  };
} // namespace retroforge
