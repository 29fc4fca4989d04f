// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/box_tree.h>

#include <array>
#include <cstdint>
#include <functional>

namespace retroforge
{
  /// Wanted lengths that have no closed form, and that are not graded, as an octree tabulates them.
  struct SizeSource
  {
    /// The wanted length at a point [mm].
    std::function<double(const Vec3 &x)> at;

    /// A length that is wanted nowhere within a distance of a point, or any smaller one [mm].
    std::function<double(const Vec3 &x, double distance)> below;
  };

  /// Bounds of an octree's lengths [mm], and their growth per distance, dimensionless.
  struct SizeOctreeLimits
  {
    double smallest, largest, growth;
  };

  /// Wanted length of edges, graded and tabulated on an octree of cubes:
  ///
  ///   h(x_a) = min( h_0, min_b ( clamp(s(x_b)) + g d(a, b) ) )   at the corners x_a of the leaves,
  ///
  /// s the source, d the distance along straight lines between corners of one leaf; trilinear inside a leaf.
  ///
  /// The octree is p4est's, by deal.II: hexahedra of parallel::distributed::Triangulation, each next to such
  /// as are at most twice as large or half. A leaf is divided while it is larger than three times the
  /// smallest length that the source may want inside. Once it is made, a flat array of leaves in Morton order
  /// remains, and a question is a binary search. Each process makes an octree of its own: the same
  /// everywhere, and no communication.
  ///
  /// Corners of leaves lie on a fixed lattice in space, so that neighbouring designs share them.
  class SizeOctree
  {
  public:
    /// @param domain    boxes that cover the points which will be asked for; elsewhere leaves stay large
    /// @param source    asked at corners of leaves that meet the domain only
    SizeOctree(const std::vector<BoundingBox> &domain,
               const SizeSource               &source,
               const SizeOctreeLimits         &limits);

    /// O(log leaves). Beyond the octree it is that of its closest point.
    double operator()(const Vec3 &x) const;

    unsigned int n_leaves() const { return leaves_.size(); }

    /// A cube of the octree.
    struct Leaf
    {
      std::uint64_t         key;   ///< of its lowest corner in Morton order
      std::uint32_t         width; ///< of its edges, in edges of the finest cubes that can be
      std::array<double, 8> size;  ///< at its corners, in deal.II's order: x runs first [mm]
    };

    /// In Morton order.
    const std::vector<Leaf> &leaves() const { return leaves_; }

  private:
    const Leaf &leaf_at(const std::array<std::uint32_t, 3> &lattice) const;

    Vec3              origin_;
    double            unit_ = 1.; ///< edge of the finest cubes that can be [mm]
    std::vector<Leaf> leaves_;
  };
} // namespace retroforge
