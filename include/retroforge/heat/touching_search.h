// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/heat/thermal_surface.h>

/// @file
/// The nodes and edges that thermal_surface.h looks at, and how they see their dies.
namespace retroforge
{
  template <typename Number>
  Vector3<Number> middle_of(const NodalVectors<Number> &X, const std::array<NodeIndex, 2> &nodes)
  {
    return 0.5 * (X[nodes[0]] + X[nodes[1]]);
  }

  /// Returns a surface of all nodes and edges that may touch, without weights: edges where a die bulges into them, or which
  /// come nearer.
  /// @param touch  whether each die is there to be touched
  template <typename Number>
  ThermalSurface<Number>
  find_touching(const ContactView<Number> &view, const std::vector<bool> &touch, const ThermalReach &reach);

  /// The velocity of the metal at a node, or at the middle of an edge, as ContactView has it.
  template <typename Number>
  class MetalVelocity
  {
  public:
    MetalVelocity(const ContactView<Number> &view, const NodeIndex node)
    {
      if (view.velocity && !view.velocity->empty())
        value_ = (*view.velocity)[node];
    }
    MetalVelocity(const ContactView<Number> &view, const std::array<NodeIndex, 2> &nodes)
    {
      if (view.velocity && !view.velocity->empty())
        value_ = middle_of(*view.velocity, nodes);
    }

    /// Null where it is not known.
    const Vector3<Number> *get() const { return value_ ? &*value_ : nullptr; }

  private:
    std::optional<Vector3<Number>> value_;
  };

  /// How the nodes and middles of a surface see their dies.
  template <typename Number>
  struct Sights
  {
    std::vector<Projection<Number>> of_nodes, of_middles;

    Sights(const ContactView<Number> &view, const ThermalSurface<Number> &surface);

    /// Of the die into edge e [mm].
    Number bulge(const TouchingEdge<Number> &edge, const unsigned int e) const
    {
      return 0.5 * (of_nodes[edge.ends[0]].delta + of_nodes[edge.ends[1]].delta) - of_middles[e].delta;
    }
  };

  /// Derivatives in a sight.
  struct SightBar
  {
    double delta = 0.;
    Vec3   n;
  };

  /// Reverse of Sights: adds to X_bar, and to the dies' displacements and vertices.
  void reverse_sights(const ContactView<double>     &view,
                      const ThermalSurface<double>  &surface,
                      const std::vector<SightBar>   &nodes_bar,
                      const std::vector<SightBar>   &middles_bar,
                      NodalVectors<double>          &X_bar,
                      std::vector<DieState<double>> &dies_bar);
} // namespace retroforge
