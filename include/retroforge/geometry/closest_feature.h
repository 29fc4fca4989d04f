// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/triangle_surface.h>

#include <limits>

namespace retroforge
{
  /// Part of a die: a facet, one of its edges or one of its corners. A recorded decision, frozen in replays
  /// and derivatives. A plane is the facet 0.
  struct DieFeature
  {
    unsigned int  facet = 0;
    unsigned char kind  = 0; ///< 0 the face, 1 + e its edge e, 4 + c its corner c, or `flat_face`

    static constexpr unsigned char n_kinds   = 8;
    static constexpr unsigned char flat_face = 7; ///< the face of a smooth surface as a plane, see Die

    static constexpr DieFeature none() { return {invalid_index, 0}; }
    bool                        found() const { return facet != invalid_index; }
    bool operator==(const DieFeature &other) const { return facet == other.facet && kind == other.kind; }
    bool operator!=(const DieFeature &other) const { return !(*this == other); }
  };

  /// The feature of a surface that is closest to a point.
  ///
  /// A tree of boxes around the facets serves as a lower bound only, so that distances, ties and signs are
  /// ours. (CGAL's AABB tree returns the point but not the edge or corner it lies on.)
  ///
  /// An edge is named by the lowest of its facets, a vertex likewise. Among features that are equally close
  /// (to 1e-12) the facet of the lowest index wins.
  class ClosestFeature
  {
  public:
    explicit ClosestFeature(const TriangleSurface &surface);

    /// @param within  nothing farther away is looked for; DieFeature::none() is returned then, and behind the
    /// rim of an open surface: a point whose closest feature is part of the rim is beyond the surface, and
    /// in front of it or not there at all. Points beyond the rim by less than TriangleSurface::rounding()
    /// count as over the face.
    DieFeature operator()(const Vec3 &X, double within = std::numeric_limits<double>::max()) const;

  private:
    const TriangleSurface &surface_;
    BoxTree                tree_;
  };

  /// Finds the closest feature by looking at every facet: the reference that the search is tested against.
  DieFeature closest_feature_of_all(const TriangleSurface &surface, const Vec3 &X, double within);
} // namespace retroforge
