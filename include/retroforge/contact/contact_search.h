// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/contact_point.h>
#include <retroforge/discretization/middle_nodes.h>
#include <retroforge/geometry/die.h>

#include <mpi.h>

#include <optional>

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
  ///
  /// The width is that where dies close head-on. A wall along which they close comes near the metal slower, and
  /// has less of it: see RampScales.
  struct FrictionRamp
  {
    double width = 0.; ///< [mm]
    bool   sharp = false;
    double wall  = 1.; ///< part of the width that walls have, at most 1

    /// @param touching  the recorded decision delta <= width, which alone counts when sharp
    template <typename Number>
    Number operator()(const Number &delta, bool touching) const;
    double derivative(double delta) const;

    /// The part with which an edge that touches counts for its ends,  g = 1 - w(4 b),  b the bulge of the die into it: none
    /// where the die only begins to bulge into it, so that nothing jumps there; all where it bulges by a quarter of the
    /// width. Where b is small beside that, the ends are as near as the edge and need none: of ends that are b away from
    /// a die which the edge touches, at least 0.99 touch. (By 1 - w(b) it was 0.75, and friction on the hub too low.)
    template <typename Number>
    Number part_of_edge(const Number &bulge) const
    {
      return 1. - (*this)(Number(steepness * bulge), false);
    }
    double slope_of_edge(const double bulge) const { return -steepness * derivative(steepness * bulge); }

  private:
    static constexpr double steepness = 4.;
  };

  /// Parts of a ramp's width that points of the dies have,
  ///   s = sqrt(wall^2 + (1 - wall^2) r^2),  r = max(0, (v - v_d)·n)/c,
  /// v the velocity of the metal there in the increment before, n the normal of the die d at the point, and c
  /// the speed at which dies close: the largest of |v_d| and |v_d - v_b|, b the other dies. So friction sets in
  /// over the path by which a point comes nearer, whatever its die: a wall along which dies close, or a roller
  /// on which a bar lies, has no part of what does not touch it. Where the metal's velocity is not known, it is
  /// taken to rest relative to what the die closes with:  r = n·e, e the direction of c. It is 1 where no die
  /// moves; ramps are w(delta/s).
  template <typename Number>
  class RampScales
  {
  public:
    RampScales(const FrictionRamp &ramp, const std::vector<DieState<Number>> &states);

    /// @param metal  its velocity; null where it is not known [mm/s]
    Number operator()(unsigned int die, const Vector3<Number> &n, const Vector3<Number> *metal) const;

    /// Adds the derivatives of  s_bar * (*this)(die, n, metal); those in the metal's velocity where it is known.
    void reverse(unsigned int                   die,
                 const Vector3<Number>         &n,
                 const Vector3<Number>         *metal,
                 double                         s_bar,
                 Vector3<Number>               &n_bar,
                 Vector3<Number>               &metal_bar,
                 std::vector<DieState<Number>> &states_bar) const;

  private:
    struct Closing
    {
      Vector3<Number> velocity; ///< relative to `other`, or to the metal
      unsigned int    other = invalid_index;
    };

    const std::vector<DieState<Number>> &states_;
    double                               wall_;
    std::vector<Closing>                 closing_; ///< for each die, where walls differ; else empty
  };

  /// A point in reach of a die: a recorded decision.
  struct ContactPair
  {
    ContactPoint point;
    unsigned int die;
    bool         touching; ///< delta <= width of the friction ramp there
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
    /// Of the nodes in the increment before [mm/s]; null or empty where it is not known.
    const std::vector<Vector3<Number>> *velocity = nullptr;

    /// Returns the velocity of a point that moves with the nodes; nothing where it is not known.
    std::optional<Vector3<Number>> velocity_of(const ContactPoint &point) const
    {
      if (!velocity || velocity->empty())
        return {};
      return point.position(*velocity);
    }
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
