// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/cavity.h>
#include <retroforge/objective/final_objective.h>

/// @file
/// The volume between flat facets of the workpiece and a curved die they lie on.
///
/// Facets whose nodes rest on a round die are chords: metal that fills a bore of radius R with elements of
/// size h leaves h^2/(6 R^2) of it empty. That is the mesh's and not the forging's. From the gaps delta at the
/// corners, the middles of the edges and the centre of a facet of area A (weights 1/20, 2/15, 9/20: exact for
/// cubics) follow the mean gap m, that of the corners c, and the bulge b = m - c of the die away from the
/// facet. What counts as unfilled is
///   g = (m - t b+)+
/// so that neither corners on the die (c = 0: a hollow die) nor edges on it (m = 0: a convex one) leave
/// anything, while a gap counts from where it begins; and metal in a die fills no other place. x+ is x for
/// x > r, 0 for x < 0, and x times the step of the friction ramp between, r = l/1000 and l^2 = 2 A. The weight
/// t is 1 for a facet on a die that is smooth there. It falls to 0 over b = 0.06 l ... 0.15 l, as it does for
/// levelled gaps (level_gaps.h), over c = 0 ... l, and while the die's normal turns from the facet's by 25 to
/// 45 degrees, at its centre or at a corner that is off the die by l/20 (on an edge of the die the normal says
/// nothing): a facet that spans an edge or a narrow rounding counts as it is, and so does one that is far
/// away.
namespace retroforge
{
  /// A facet of the workpiece near a die, and what its points see: corners, middles of edges, centre.
  struct FacetAtDie
  {
    std::array<NodeIndex, 3>  nodes;
    std::array<DieFeature, 7> features;

    /// Returns the positions of the points.
    template <typename Number>
    static std::array<Vector3<Number>, 7> points(const std::array<Vector3<Number>, 3> &x)
    {
      return {{x[0],
               x[1],
               x[2],
               (x[0] + x[1]) * Number(0.5),
               (x[1] + x[2]) * Number(0.5),
               (x[2] + x[0]) * Number(0.5),
               (x[0] + x[1] + x[2]) * Number(1. / 3.)}};
    }

    /// Adds the transpose of points().
    static void add_points(const std::array<Vec3, 7> &points_bar, std::array<Vec3, 3> &x_bar);
  };

  /// What a facet sees of a die.
  template <typename Number>
  struct FacetGaps
  {
    std::array<Number, 7>          delta; ///< [mm]
    std::array<Vector3<Number>, 4> n;     ///< into the die, at the corners and the centre
  };

  /// Returns this rank's facets that come nearer to the die than they are long.
  std::vector<FacetAtDie>
  find_facets_at_die(const FinalView<double> &view, const Die &die, const Vec3 &displacement, const Box &box);

  /// Returns A (m - g), the volume between a facet and the die that does not count; or A (m+ - g), where what
  /// is behind the surface was not counted before [mm^3].
  template <typename Number>
  Number volume_at_facet(const std::array<Vector3<Number>, 3> &x, const FacetGaps<Number> &gaps, bool behind);

  /// Returns the part of a triangle that lies in the half-spaces, 0 to 1.
  template <typename Number>
  Number share_of_facet(const std::array<Vector3<Number>, 3> &x,
                        const std::vector<HalfSpace<Number>> &half_spaces);

  /// Returns the area of a facet times the mean of three gaps.
  template <typename Number>
  Number volume_of_bulge(const std::array<Vector3<Number>, 3> &x, const std::array<Number, 3> &delta);
} // namespace retroforge
