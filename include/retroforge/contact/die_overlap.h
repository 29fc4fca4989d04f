// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/metal_surface.h>
#include <retroforge/geometry/die.h>

#include <optional>

#include <mpi.h>

/// @file
/// Where a die and the metal are in one another, found from all of both surfaces: vertices and edges of the
/// die against faces of the metal as well as the metal's nodes against the die.
namespace retroforge
{
  /// Metal and a die in one another.
  struct Overlap
  {
    double depth = 0.; ///< [mm]; 0 where they are apart or touch
    Vec3   place;      ///< the deepest point
    /// True for a point of the die in the metal, false for one of the metal in the die.
    bool is_of_die = false;
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
} // namespace retroforge
