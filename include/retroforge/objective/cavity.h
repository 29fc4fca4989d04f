// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/clipped_volume.h>
#include <retroforge/geometry/die.h>
#include <retroforge/mesh/tet_mesh.h>
#include <retroforge/objective/box.h>

/// @file
/// The volume in front of a triangulated surface within a convex region.
///
/// Seen from a point p of the region, the facet t hides its shadow: the points x of the region whose segment
/// from p crosses t. A point is in front of the surface if p is, and the crossings say otherwise as often as
/// not, so that of any convex body P with p in it the volume
///   |P in front| = w |P| + sum_t s_t |P in the shadow of t|
/// is in front, w = 1 if p is in front or else 0, s_t = 1 where the segment enters through t what is in front,
/// -1 where it leaves it. A shadow is cut out by four planes: three through p and an edge of t, and that of
/// t. Each summand is continuous in all that it depends on, so that facets which touch a body do no harm.
namespace retroforge
{
  /// How a region lies at a moment.
  template <typename Number>
  struct RegionPlace
  {
    Vector3<Number> shift;              ///< from where it was recorded
    Number          mouth = Number(0.); ///< of the vertex that its mouth follows, along the axis [mm]
  };

  /// The convex region that a cavity is cut from: a box, what lies behind the mouth of a die, and the sector
  /// that symmetry planes left. A recorded decision.
  struct Region
  {
    Box  box;
    bool follows_die = false; ///< moves with the die; the box of a user stands still

    /// The mouth, a plane across the axis, which points into the die, through a vertex, moved by a depth.
    unsigned int mouth_vertex = invalid_index; ///< of the die; invalid_index: there is no mouth
    Vec3         axis;
    double       mouth_depth = 0.; ///< [mm]

    std::vector<Plane> sector;

    /// The place that the shadows are seen from, without the shift, and whether it is in front.
    Vec3 eye;
    bool eye_in_front = true;

    /// Returns the place of the region.
    /// @param vertices  of the die, without the displacement
    template <typename Number>
    RegionPlace<Number> place(const NodalVectors<Number> &vertices, const Vector3<Number> &displacement) const
    {
      RegionPlace<Number> place;
      if (follows_die)
        place.shift = displacement;
      if (mouth_vertex != invalid_index)
        place.mouth = axis * vertices[mouth_vertex];
      return place;
    }

    /// Returns the half-spaces of the mouth, if there is one, and of the sector.
    template <typename Number>
    std::vector<HalfSpace<Number>> mouth_and_sector(const RegionPlace<Number> &place) const;

    /// Returns all half-spaces: of the box first.
    template <typename Number>
    std::vector<HalfSpace<Number>> half_spaces(const RegionPlace<Number> &place) const;

    /// Returns the volume of the region [mm^3].
    template <typename Number>
    Number volume(const RegionPlace<Number> &place) const;

    /// Returns the volume of the region in the shadow of a facet, with the sign s_t [mm^3].
    template <typename Number>
    Number shadow(const RegionPlace<Number> &place, const std::array<Vector3<Number>, 3> &facet) const;
  };

  /// Returns the region of a surface: the box or, without one, what lies behind the mouth of an open surface.
  /// The mouth is a plane across the facing, the mean normal across the symmetry planes that the surface
  /// reaches, at its foremost vertex but for a thousandth of its depth: what rests on the face around a cavity
  /// is outside.
  /// @param die          with its vertices where they are
  /// @throws Error  where symmetry planes leave nothing of it
  Region
  make_region(const Die &die, const Vec3 &displacement, const std::optional<Box> &box, const TetMesh &mesh);

  /// Returns the volume of a tetrahedron in the shadow of a facet seen from a point of it, with the sign s_t,
  /// in the half-spaces [mm^3].
  template <typename Number>
  Number shadow_in_tetrahedron(const Tetrahedron<Number>            &x,
                               const Vector3<Number>                &eye,
                               const std::array<Vector3<Number>, 3> &facet,
                               const std::vector<HalfSpace<Number>> &half_spaces);
} // namespace retroforge
