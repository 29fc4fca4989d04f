// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/die_overlap.h>

/// @file
/// Position of a die relative to the billet, and its first contact with it, found from both surfaces:
/// vertices and edges of the die against faces of the metal, and nodes of the metal against the die.
namespace retroforge
{
  /// First contact of a die that moves along a line with metal at rest.
  struct Meeting
  {
    double travel; ///< path of the die until then [mm]
    Vec3   place;  ///< on the metal
  };

  /// The first contact of the facets, exactly: over all pairs of a facet of the die that looks along the way
  /// and a face of the metal that looks back, the least distance along the way where both lie over one
  /// another. What is in one another by less than `touching` or touches meets at 0, and what is farther in is
  /// left behind. None when they never meet.
  /// @param way  of any length but zero      @param touching  [mm]
  std::optional<Meeting> first_meeting(const Die          &die,
                                       const Vec3         &displacement,
                                       const Vec3         &way,
                                       const MetalSurface &metal,
                                       double              touching);

  /// Returns the least distance that a die must move along a way, so that its facets and the metal's stay
  /// apart from there on [mm]; 0 where they are apart already, infinite for a plane that does not move away
  /// from the metal.
  /// @param way  of length one
  double
  travel_to_be_free(const Die &die, const Vec3 &displacement, const Vec3 &way, const MetalSurface &metal);

  /// Returns how much of the metal that looks against a way has the die in front of it: seen along the way, the part
  /// of its area. Facets of the die count wherever along the way they are; where several lie over one another
  /// in front of a face, it is at most as much as they have together. A plane that looks along the way covers all.
  double covered_part(const Die &die, const Vec3 &displacement, const Vec3 &way, const MetalSurface &metal);

  /// Returns the shortest distance between a die's facets and the metal's [mm], and its end on the metal;
  /// meaningless where they overlap.
  std::pair<double, Vec3>
  shortest_distance(const Die &die, const Vec3 &displacement, const MetalSurface &metal);

  /// Position of a die relative to the billet at the start: overlap or gap, and the contact that its motion
  /// leads to.
  struct DieApproach
  {
    Overlap overlap;
    /// The shortest of the moves looked at after which the facets are apart: against its velocity, against
    /// its facing, and across the surface where they overlap most [mm]. Zero without overlap.
    Vec3   freeing;
    double gap = 0.;  ///< shortest distance to the billet; 0 where they overlap or touch [mm]
    Vec3   gap_place; ///< the end of it on the billet
    /// First contact along the die's velocity; none for a die at rest, or one that never meets the billet.
    std::optional<Meeting> meeting;
    bool                   moves_away = false; ///< it would meet the billet if it went back
  };

  /// @param velocity  zero: it stands
  /// @param facing    from the die towards the metal
  /// @param touching  what overlaps by less touches [mm]
  DieApproach find_approach(const Die          &die,
                            const Vec3         &displacement,
                            const Vec3         &velocity,
                            const Vec3         &facing,
                            const MetalSurface &metal,
                            double              touching);
} // namespace retroforge
