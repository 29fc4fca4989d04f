// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/contact_law.h>
#include <retroforge/contact/contact_search.h>
#include <retroforge/contact/rigid_hold.h>

#include <algorithm>
#include <cmath>

/// @file
/// Gaps, normals and ramps of the points that contact looks at, and the speeds at which gaps close.
///
/// For a point against a die, its position and velocity means of its nodes' (ContactPoint):  u = V_k - v_die,
/// h = u·n - a(delta),  a = delta/tau or, with a layer l, l/tau asinh(delta/l),  dv = u - (u·n) n.
/// A node held off the die by an edge that touches counts as touching, as far as the die bulges into the edge.
///
/// Uniform pressure does not load the vertices of a quadratic velocity: whether one is pressed would be
/// decided by the last digits. So one is pressed, too, where the middles of all its surface edges are. On
/// curved dies the gaps are those that flat faces can close (level_gaps.h).
///
/// What belongs to the increment (delta, n, w, tau) is found once at X_i and kept for all its stages:
/// ContactSet. What belongs to a stage, the areas, is computed from the stage's positions (contact_areas.h).
namespace retroforge
{
  /// The speed at which a gap closes, besides its approach time tau: see approach_speed().
  struct ApproachLaw
  {
    double layer    = 0.; ///< layer l of the approach speed [mm]; 0: none
    double part     = 1.; ///< part of a whole increment, 1 unless it was cut
    double recovery = 1.; ///< part of tau over the time in which edges that sank into a die come out of it

    ApproachLaw(const double layer = 0., const double part = 1., const double recovery = 1.)
        : layer(layer), part(part), recovery(recovery)
    {
    }

    /// Returns that of a point: nodes and middles with a velocity of their own hardly sink, and come out at once.
    ApproachLaw of(const ContactPoint &point) const
    {
      return {layer, part, point.has_own_velocity() ? 1. : recovery};
    }
  };

  /// Numerical settings that stand in an increment's equations of contact. They are recorded with the
  /// increment, since a run may go on with other numerics: the backward sweep and the replay use what was
  /// used.
  struct ContactNumerics
  {
    double       approach = 1.;       ///< approach time in increments: tau = approach * dt
    double       layer    = 0.;       ///< layer l of the approach speed [mm]; 0: none
    double       step     = 0.;       ///< stroke of a whole increment [mm]
    FrictionRamp ramp;                ///< of a whole increment
    double       edge_stiffness = 1.; ///< penalty of edges over that of nodes, dimensionless
    /// Whether energies and forces have their part of the work on gaps that close (spent_power.h).
    bool counts_closing = true;
    /// Stroke within which edges that sank into a die come out of it, or that of the increment where that is
    /// longer [mm]. Pressed edges sink by the part edge_sinking of it. Were it that of the increment, edges
    /// would be thrown out wherever increments become shorter, and the metal pressed with them.
    double recovery = 0.;

    /// Returns the approach law of an increment with the given stroke [mm].
    ApproachLaw approach_law(const double stroke) const
    {
      return {layer, part_of(stroke), recovery > stroke ? stroke / recovery : 1.};
    }

    /// Returns the ramp in an increment with the given stroke [mm].
    FrictionRamp ramp_in(const double stroke) const
    {
      FrictionRamp cut = ramp;
      cut.width *= part_of(stroke);
      return cut;
    }

    /// Returns how near a point is to a die that it touches, not in part only, in an increment with the given
    /// stroke: half the ramp, which is the path by which the dies close [mm].
    double near_in(const double stroke) const { return 0.5 * ramp_in(stroke).width; }

    /// Returns those of whole increments with another stroke [mm].
    ContactNumerics in_steps_of(const double stroke) const
    {
      ContactNumerics other = *this;
      other.step            = stroke;
      other.layer *= stroke / step;
      other.ramp.width *= stroke / step;
      return other;
    }

  private:
    double part_of(const double stroke) const { return step > 0. ? std::min(1., stroke / step) : 1.; }
  };

  /// An edge of the surface, whose ends and middle are in reach of one curved die.
  struct Chord
  {
    unsigned int                middle;
    std::array<unsigned int, 2> ends;   ///< entries in ContactSet::pairs, as the middle's
    std::array<unsigned int, 2> images; ///< how often it stands at each end in the whole
  };

  /// Contact as found at the start of an increment.
  template <typename Number>
  struct ContactSet
  {
    struct Face
    {
      unsigned int                face;   ///< index into TetMesh::faces
      std::array<unsigned int, 3> points; ///< its corners' entries in `pairs`
      Number                      weight; ///< product of the three ramps
    };

    std::vector<ContactPair>        pairs;
    std::vector<Projection<Number>> projections; ///< for each pair, at X_i
    std::vector<Number>             scales;      ///< of the ramp of each pair: RampScales
    /// w(delta/s) for each pair; for a node at which edges may touch in its place,
    ///   1 - (1 - w) product_m (1 - (1 - w(4 b_m/s_m)) w_m),
    /// b_m the bulge of the die into the edge with the middle m.
    std::vector<Number> ramps;
    /// The factors of this product: (pair of a node, pair of an edge at it).
    std::vector<std::array<unsigned int, 2>> touched_by_edges;
    /// Faces or, where velocities are quadratic, the four equal triangles that the middles of its edges cut
    /// each into.
    std::vector<Face> friction_faces;
    /// For quadratic velocities: for each pair of a vertex, the pairs of its surface edges' middles, provided
    /// that all of them are in reach of its die and the die is smooth there; none otherwise, and none for
    /// middles.
    std::vector<std::vector<unsigned int>> middles_around;
    /// For quadratic velocities: edges at a curved die, and all gaps before they were levelled [mm].
    std::vector<Chord>  chords;
    std::vector<Number> own_gaps;
    /// Squares of strain rates at the pairs that laws of friction follow (surface_rates.h) [1/s^2]; empty: none
    /// does.
    std::vector<Number> rates;
    /// For each pair, the weights of its die's zones (geometry/friction_zones.h); empty: no die has any.
    std::vector<std::vector<Number>> zones;
    bool                             quadratic = false;
    Number                           tau       = 1.; ///< approach time [s]
    ApproachLaw                      approach;
    double    edge_stiffness = 1.;   ///< penalty of edges over that of nodes, dimensionless
    bool      counts_closing = true; ///< as ContactNumerics::counts_closing
    RigidHold hold;                  ///< of what pairs leave loose
  };

  /// w(gap/s) of pair p.
  template <typename Number>
  Number own_ramp(const ContactSet<Number> &contact,
                  const FrictionRamp       &ramp,
                  const unsigned int        p,
                  const Number             &gap)
  {
    return ramp(Number(gap / contact.scales[p]), contact.pairs[p].touching);
  }

  /// Adds the derivatives of  w_bar * own_ramp(...)  in the gap and the scale.
  inline void reverse_own_ramp(const ContactSet<double> &contact,
                               const FrictionRamp       &ramp,
                               const unsigned int        p,
                               const double              gap,
                               const double              w_bar,
                               double                   &gap_bar,
                               double                   &scale_bar)
  {
    const double s = contact.scales[p], slope = w_bar * ramp.derivative(gap / s);
    gap_bar += slope / s;
    scale_bar -= slope * gap / (s * s);
  }

  /// Derivatives in the increment's data: what ContactSet depends on is filled in later, by
  /// reverse_contact_set.
  struct ContactSetBar
  {
    std::vector<double>              delta, ramp, rates;
    std::vector<Vec3>                n;
    std::vector<std::vector<double>> zones; ///< empty: none

    explicit ContactSetBar(const std::size_t n_pairs)
        : delta(n_pairs, 0.), ramp(n_pairs, 0.), rates(n_pairs, 0.), n(n_pairs)
    {
    }
  };

  /// The laws by which points approach the dies in an increment, and by which friction sets in.
  template <typename Number>
  struct ContactApproach
  {
    FrictionRamp ramp;
    Number       tau; ///< approach time [s]
    ApproachLaw  law            = {};
    double       edge_stiffness = 1.;   ///< penalty of edges over that of nodes, dimensionless
    bool         counts_closing = true; ///< as ContactNumerics::counts_closing
  };

  /// Gaps, normals and ramps of given pairs. Collective: each rank projects its share of them.
  template <typename Number>
  ContactSet<Number> make_contact_set(const ContactView<Number>      &view,
                                      const std::vector<ContactPair> &pairs,
                                      const ContactApproach<Number>  &approach);

  /// Pull-back of make_contact_set: adds to X_bar, to the derivatives in the velocity of the increment before
  /// where it is known, to the dies' displacements and velocities, and to vertices where there is an entry for
  /// each.
  void reverse_contact_set(const ContactView<double>     &view,
                           const ContactSet<double>      &contact,
                           const FrictionRamp            &ramp,
                           const ContactSetBar           &bar,
                           NodalVectors<double>          &X_bar,
                           NodalVectors<double>          &velocity_bar,
                           std::vector<DieState<double>> &dies_bar);

  /// The part of a zone of the die in the friction at a point.
  template <typename Number>
  struct ZonePart
  {
    Number               weight = Number(0.);
    ZoneFriction<Number> law;
  };

  /// A contact point with everything that its force depends on.
  template <typename Number>
  struct ContactNode
  {
    Vector3<Number> u; ///< V - v_die
    Vector3<Number> n;
    Number          delta, tau, S, Sf;
    Number          alpha;
    bool            active; ///< counts as h > 0
    ApproachLaw     approach;
    unsigned int    interface_law = 0; ///< number of the die's law (interface_law.h)
    Number          shear_limit   = Number(0.);
    Number          rate2         = Number(0.); ///< square of the metal's strain rate, frozen [1/s^2]

    std::vector<ZonePart<Number>> zones = {}; ///< what zones have of its friction; the rest is the die's own
  };

  /// Speed at which a gap may close: delta/tau, so that what is in reach arrives within tau; with a layer l
  ///   l/tau A,  A = asinh(delta/l),
  /// the same near the die, but flatter where a free node meets it. The force then sets in gradually, and the
  /// energy is smoother in the design, at less delay than a longer tau costs.
  ///
  /// What is inside a die comes out of it at no more than 2 l in a whole increment, and that part of it in
  /// one that was cut:  A -> A (1 + (A / (2 part))^2)^(-1/2)  for delta < 0. Without that bound a shorter
  /// increment would throw it out so much faster, and however short it is, elements would be turned over.
  /// Edges come out more slowly, by the factor `recovery`.
  template <typename Number>
  Number approach_speed(const Number &delta, const Number &tau, const ApproachLaw &law)
  {
    using std::log;
    using std::sqrt;
    const double recovery = value_of(delta) < 0. ? law.recovery : 1.;
    if (law.layer == 0.)
      return recovery * delta / tau;
    const Number s = delta / law.layer;
    if (value_of(s) >= 0.)
      return law.layer / tau * log(Number(sqrt(Number(1. + s * s)) + s));
    const Number A = log(Number(sqrt(Number(1. + s * s)) - s)), a = A * (1. / (2. * law.part));
    return -recovery * law.layer / tau * A / sqrt(Number(1. + a * a));
  }

  /// Returns the derivative of approach_speed() in delta [1/s].
  inline double approach_slope(const double delta, const double tau, const ApproachLaw &law)
  {
    const double recovery = delta < 0. ? law.recovery : 1.;
    if (law.layer == 0.)
      return recovery / tau;
    const double s = delta / law.layer, slope = recovery / (tau * std::sqrt(1. + s * s));
    if (s >= 0.)
      return slope;
    const double a = std::asinh(-s) / (2. * law.part);
    return slope / std::pow(1. + a * a, 1.5);
  }

  /// Returns the gap whose approach speed is `speed` > 0: the inverse function of approach_speed() [mm].
  inline double approach_distance(const double speed, const double tau, const ApproachLaw &law)
  {
    return law.layer == 0. ? speed * tau : law.layer * std::sinh(speed * tau / law.layer);
  }

  template <typename Number>
  Number approach_excess(const ContactNode<Number> &node)
  {
    return node.u * node.n - approach_speed(node.delta, node.tau, node.approach);
  }

  /// Velocity along the die [mm/s].
  template <typename Number>
  Vector3<Number> slip(const ContactNode<Number> &node)
  {
    return node.u - node.n * Number(node.u * node.n);
  }

  /// Derivatives of a scalar of one node.
  struct ContactNodeBar
  {
    Vec3   u, n;
    double delta = 0., tau = 0., S = 0., Sf = 0., alpha = 0., shear_limit = 0., rate2 = 0.;

    MaterialLaw<double> law;
    ContactLaw<double>  contact;

    std::vector<ZonePart<double>> zones = {}; ///< empty: none
  };

  /// Adds the derivatives in u, n, delta and tau of a scalar whose derivatives in dv and h are given.
  void
  reverse_kinematics(const ContactNode<double> &node, const Vec3 &dv_bar, double h_bar, ContactNodeBar &bar);
} // namespace retroforge
