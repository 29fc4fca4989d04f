// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/tet_mesh.h>
#include <retroforge/objective/box.h>

namespace retroforge
{
  /// The sector of space that symmetry planes leave: the part of a whole target that faces the model.
  class Sector
  {
  public:
    Sector() = default; ///< all of space
    explicit Sector(const TetMesh &mesh);

    /// Returns whether a point belongs to it: those on the planes do, to rounding.
    bool contains(const Vec3 &x) const;

    /// Returns the part of a box of the given edges around x that belongs to it, 0 to 1: exact for a plane
    /// along the axes, and linear in the distance of others.
    double share(const Vec3 &x, const Vec3 &edges) const;

    /// Returns the box without what planes along the axes cut off.
    Box clipped(Box box) const;

  private:
    std::vector<Plane> planes_;
  };
} // namespace retroforge
