// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/contact_kinematics.h>

/// @file
/// Gaps of quadratic velocities to curved dies, such that flat faces can close them all.
///
/// A face stays flat, and a curved die bulges into it. If vertices and middles of edges were all to come to
/// where their own gaps vanish, the ends of an edge would drive its middle out of the die or into it, and the
/// middle its ends, in each increment anew: a ripple of velocities that never ends, since there are three
/// middles for each vertex that can move. So the bulge of the die into an edge (a, b) with middle m,
///   b_m = (delta_a + delta_b)/2 - delta_m,
/// belongs to the geometry and not to contact. Where its edges touch, a vertex is to stand off the die by the
/// mean bulge around it, so that as much metal is missing as is in the die, and a middle where its ends want
/// it:
///   o_v      = sum_m w_m c_m b_m / (sum_m w_m + 1/4),   w_m = w(delta_m),
///   delta'_v = delta_v - o_v,
///   delta'_m = delta_m + w'_a w'_b c_m ((delta'_a + delta'_b)/2 - delta_m),   w' = w(delta'),
/// with sums over the edges at v in the whole.
/// An edge that spans a sharp corner of the die is held out by its own gap: c_m falls from 1 at |b_m| = 0.06
/// of the edge's length, that is a length of 0.48 radii, to 0 at 0.15. There a ripple remains, and a vertex
/// that is pressed because the middles around it are would take part in it by pulling: where c_m < 1,
/// vertices decide for themselves.
namespace retroforge
{
  /// Bulges over an edge's length up to which a die counts as smooth, and from which on as sharp.
  constexpr double smooth_bulge = 0.06, sharp_bulge = 0.15;

  /// The edges at curved dies, from pairs whose projections are there.
  /// @param pair_of  the pair of (die, velocity node), where there is one
  template <typename Number, typename PairOf>
  std::vector<Chord>
  find_chords(const ContactView<Number> &view, const std::vector<ContactPair> &pairs, const PairOf &pair_of)
  {
    std::vector<Chord> chords;
    const auto        &edges = view.topology.surface_edges;
    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      const ContactPoint &point = pairs[p].point;
      if (point.is_node() || !view.dies[pairs[p].die].surface())
        continue;
      const auto a = pair_of.find({pairs[p].die, point.nodes[0]}),
                 b = pair_of.find({pairs[p].die, point.nodes[1]});
      if (a == pair_of.end() || b == pair_of.end())
        continue;
      const auto edge = std::lower_bound(edges.begin(), edges.end(), point.nodes);
      chords.push_back({p, {{a->second, b->second}}, view.topology.edge_images[edge - edges.begin()]});
    }
    return chords;
  }

  /// Statistics of the misfit between straight edges and the curved dies they touch.
  struct EdgeFit
  {
    /// Edges whose middle or both ends are at least half in contact, by their ramps.
    unsigned int touching = 0;
    unsigned int spanning = 0;             ///< touching edges that span a corner of the die: c_m = 0
    double       largest  = 0.;            ///< |b_m| over the length of the edge that spans most
    unsigned int die      = invalid_index; ///< the die under that edge
    Vec3         place;                    ///< its middle
  };

  /// Returns the statistics of a contact set with levelled gaps.  @param X  the positions it was found at
  EdgeFit
  edge_fit(const NodalVectors<double> &X, const FrictionRamp &ramp, const ContactSet<double> &contact);

  /// Makes gaps and ramps those of the levelled gaps; own gaps stay in ContactSet::own_gaps. Vertices at
  /// edges with c_m < 1 lose their middles_around.
  template <typename Number>
  void level_gaps(const NodalVectors<Number> &X, const FrictionRamp &ramp, ContactSet<Number> &contact);

  /// Pull-back of level_gaps.
  /// @param gaps_bar    derivatives in the levelled gaps; become those in the own gaps
  /// @param ramps_bar   derivatives in the ramps
  /// @param scales_bar  those in the ramps' scales are added
  void reverse_level_gaps(const NodalVectors<double> &X,
                          const FrictionRamp         &ramp,
                          const ContactSet<double>   &contact,
                          const std::vector<double>  &ramps_bar,
                          std::vector<double>        &gaps_bar,
                          std::vector<double>        &scales_bar,
                          NodalVectors<double>       &X_bar);
} // namespace retroforge
