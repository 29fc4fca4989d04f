// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/metal_surface.h>
#include <retroforge/geometry/die.h>

#include <optional>

#include <mpi.h>

/// @file
/// How a die stands to the billet and comes against it, found from all of both surfaces: vertices and edges
/// of the die against faces of the metal as well as the metal's nodes against the die.
namespace retroforge
{
  /// Metal and a die in one another.
  struct Overlap
  {
    double depth = 0.;      ///< [mm]; 0 where they are apart or touch
    Vec3   place;           ///< the deepest point
    bool is_of_die = false; ///< whether that is a point of the die in the metal, else of the metal in the die
  };

  /// The deepest vertex of the metal in the die, or vertex or edge of the die in the metal.
  ///
  /// A die whose facets stand for a smooth surface, and a metal whose facets are chords of a hollow one, are
  /// in one another only where the surfaces and the facets both are: chords alone are no overlap. Edges are
  /// measured where they pass through a face, at the eighths between one face and the next.
  Overlap find_overlap(const Die &die, const Vec3 &displacement, const MetalSurface &metal);

  /// The deepest vertex or edge of the die in the metal alone. Each rank finds that of its share of them.
  Overlap find_die_in_metal(const Die          &die,
                            const Vec3         &displacement,
                            const MetalSurface &metal,
                            MPI_Comm            comm = MPI_COMM_SELF);

  /// A part of a die that comes into the metal through the middle of a face.
  struct UnseenPart
  {
    double depth = 0., width = 0.; ///< in the metal, and across where it comes in [mm]
    Vec3   place;                  ///< there, on the metal
  };

  /// The deepest vertex or edge of the die in the metal for which neither corners nor middles of edges of the
  /// face that it is nearest to are in the die: contact at these points does not see it.
  std::optional<UnseenPart> find_unseen(const Die &die, const Vec3 &displacement, const MetalSurface &metal);

  /// Where a die that moves along a line comes against metal that stands.
  struct Meeting
  {
    double travel; ///< [mm]
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

  /// How far a die must go along a way for its facets and the metal's to be apart from there on, however far
  /// it goes [mm]; 0 where they are. Infinite for a plane that does not move away from the metal.
  /// @param way  of length one
  double
  travel_to_be_free(const Die &die, const Vec3 &displacement, const Vec3 &way, const MetalSurface &metal);

  /// The shortest distance between a die's facets and the metal's [mm], and the end of it on the metal. Of
  /// those that are in one another it means nothing.
  std::pair<double, Vec3>
  shortest_distance(const Die &die, const Vec3 &displacement, const MetalSurface &metal);

  /// How a die stands to the billet at the start, and what becomes of it as it moves.
  struct DieApproach
  {
    Overlap overlap;
    /// The shortest of the moves looked at after which the facets are apart: against its velocity, against
    /// its facing, and across the surface where they overlap most [mm]. Zero without overlap.
    Vec3   freeing;
    double gap = 0.;  ///< shortest distance to the billet; 0 where they overlap or touch [mm]
    Vec3   gap_place; ///< the end of it on the billet
    /// Along its velocity; none for a die that stands, or never comes against the billet.
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
