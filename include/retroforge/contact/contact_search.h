// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/contact_point.h>
#include <retroforge/discretization/middle_nodes.h>
#include <retroforge/geometry/die.h>

#include <mpi.h>

/// @file
/// The points of the surface that contact looks at: nodes, and middles of edges (ContactPoint).
///
/// Nodes of linear velocities alone do not keep an edge out of a die whose convex part it spans: its ends
/// touch, and its middle is in the die. So the middles of such edges are points, too. Their penalty is soft:
/// nodes and edges together are more constraints than the surface has motions, and stiff ones would fight.
/// Since gaps are found anew in each increment, what an edge gives way does not add up: a penalty at which it
/// sinks with 1 % of the press speed leaves it 1 % of an increment's stroke in the die, times the pressure
/// there over the mean one.
///
/// Where velocities are quadratic, points are the nodes of the velocity, middles of edges among them.
namespace retroforge
{
  /// w(delta): 1 where the node touches, 0 where it is out of reach.
  /// Smooth: 1 - 10t^3 + 15t^4 - 6t^5 with t = delta/width on [0, 1], twice differentiable, because nodes in
  /// contact stand exactly at delta = 0. Sharp: 1 for delta <= width.
  struct FrictionRamp
  {
    double width = 0.; ///< [mm]
    bool   sharp = false;

    /// @param touching  the recorded decision delta <= width, which alone counts when sharp
    template <typename Number>
    Number operator()(const Number &delta, bool touching) const;
    double derivative(double delta) const;
  };

  /// A point in reach of a die: a recorded decision.
  struct ContactPair
  {
    ContactPoint point;
    unsigned int die;
    bool         touching; ///< delta <= width of the friction ramp
    DieFeature   feature;  ///< feature of the die closest to the point
  };

  /// The geometry that contact depends on: the workpiece at positions X, and the dies. Decisions and laws are
  /// apart from it.
  template <typename Number>
  struct ContactView
  {
    const TetMesh                       &mesh;
    const Topology                      &topology;
    const std::vector<Die>              &dies;
    const std::vector<DieState<Number>> &states; ///< for each die
    const NodalVectors<Number>          &X;
    const MiddleNodes                   *edges = nullptr;       ///< null where velocities are linear
    MPI_Comm                             comm  = MPI_COMM_SELF; ///< ranks that look for contacts together
  };

  /// The nodes within `reach` of a die, at positions X. Where velocities are quadratic, the middles of the
  /// surface's edges within reach, too. Where they are linear and the die bulges into edges, their middles,
  /// and their ends if farther away. Deterministic order: by die, then nodes, edges, ends, each ascending.
  /// Each rank looks at its share of the points, and all find the same. Collective.
  /// @param with_edges  whether middles count that have no velocity of their own
  std::vector<ContactPair> find_contact_pairs(const ContactView<double> &view,
                                              const FrictionRamp        &ramp,
                                              double                     reach,
                                              bool                       with_edges);
} // namespace retroforge
