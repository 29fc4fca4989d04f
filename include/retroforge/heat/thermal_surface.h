// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/heat/arrivals.h>

/// @file
/// Which part of the surface at each node touches which die, and which is free. A node touches a die as far as
///   w(delta/gap),  1 - 10t³ + 15t⁴ - 6t⁵,
/// says of its gap delta. Where a die bulges into edges and their middles hold the metal, nodes stand off it, and touch as
/// for friction (contact_kinematics.h),
///   1 - (1 - w(delta/gap)) product_m (1 - (1 - w(4 b_m/gap)) w(delta_m/gap)),
/// b_m the bulge into the edge with the middle m. A face touches as the product of its nodes. A third of a face's area is a
/// node's.
///
/// Under the press, points arrive at dies while the increment goes (arrivals.h): for w(delta/gap) of nodes and middles stands
/// at its start the part of its first half for which they touch, and at its end that of the second, times w of what they are
/// farther off than was expected.
namespace retroforge
{
  /// What is expected of a point in the second half of the increment that begins: the part for which it touches by
  /// itself, and its gap at the end [mm].
  template <typename Number>
  struct Expected
  {
    Number part = Number(0.), gap = Number(0.);
  };

  /// A node in reach of a die, or with an edge that is.
  template <typename Number>
  struct TouchingNode
  {
    NodeIndex        node;
    unsigned int     die;
    DieFeature       feature;            ///< of the die, closest to the node
    Number           weight;             ///< as far as it touches
    Number           area  = Number(0.); ///< of its part of the surface that touches the die [mm^2]
    Expected<Number> later = {};
  };

  /// An edge of the surface whose middle is in reach of a die that bulges into it.
  template <typename Number>
  struct TouchingEdge
  {
    unsigned int                die;
    DieFeature                  feature; ///< of the die, closest to the middle
    std::array<NodeIndex, 2>    nodes;
    std::array<unsigned int, 2> ends;       ///< entries of `touching`
    std::array<unsigned int, 2> images;     ///< how often it stands at each end in the whole
    Expected<Number>            later = {}; ///< as TouchingNode::later, of the middle
  };

  /// A face of which all nodes are in reach of a die.
  template <typename Number>
  struct TouchingFace
  {
    std::array<unsigned int, 3> corners;           ///< entries of `touching`
    Number                      area = Number(0.); ///< what touches, of each corner's third [mm^2]
  };

  template <typename Number>
  struct ThermalSurface
  {
    std::vector<TouchingNode<Number>> touching; ///< by die, then by node, ascending
    std::vector<TouchingEdge<Number>> edges;    ///< by die, then by edge, ascending
    std::vector<TouchingFace<Number>> faces;
    std::vector<Number>               free; ///< part of the surface at each node that touches no die [mm^2]
  };

  /// Derivatives of a scalar in it.
  struct ThermalSurfaceBar
  {
    std::vector<double>           weight, touching_area; ///< of each entry of `touching`
    std::vector<Expected<double>> later;
    std::vector<Expected<double>> later_of_edge; ///< of each of `edges`
    std::vector<double>           face_area;     ///< of each of `faces`
    std::vector<double>           free;

    explicit ThermalSurfaceBar(const ThermalSurface<double> &surface)
        : weight(surface.touching.size(), 0.)
        , touching_area(surface.touching.size(), 0.)
        , later(surface.touching.size())
        , later_of_edge(surface.edges.size())
        , face_area(surface.faces.size(), 0.)
        , free(surface.free.size(), 0.)
    {
    }
  };

  /// Returns what touches where the metal is, or for the first half of the increment that begins there.
  /// @param view   with velocities where something comes nearer
  /// @param touch  whether each die is there to be touched
  template <typename Number>
  ThermalSurface<Number>
  thermal_surface(const ContactView<Number> &view, const std::vector<bool> &touch, const ThermalReach &reach);

  /// Returns what touches for the second half of an increment.
  /// @param view   at its end
  /// @param start  what touches for its first half
  template <typename Number>
  ThermalSurface<Number> thermal_surface_after(const ThermalSurface<Number> &start,
                                               const ContactView<Number>    &view,
                                               const std::vector<bool>      &touch,
                                               double                        gap);

  /// Pull-back of thermal_surface: adds to X_bar, to the dies' displacements, velocities and vertices, and to velocity_bar,
  /// which is null where the view has no velocities.
  void reverse_thermal_surface(const ContactView<double>     &view,
                               const ThermalSurface<double>  &surface,
                               const ThermalReach            &reach,
                               const ThermalSurfaceBar       &bar,
                               NodalVectors<double>          &X_bar,
                               std::vector<DieState<double>> &dies_bar,
                               NodalVectors<double>          *velocity_bar = nullptr);

  /// Pull-back of thermal_surface_after.
  void reverse_thermal_surface_after(const ThermalSurface<double>  &start,
                                     const ContactView<double>     &view,
                                     const ThermalSurface<double>  &surface,
                                     double                         gap,
                                     const ThermalSurfaceBar       &bar,
                                     ThermalSurfaceBar             &start_bar,
                                     NodalVectors<double>          &X_bar,
                                     std::vector<DieState<double>> &dies_bar);
} // namespace retroforge
