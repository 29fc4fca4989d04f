// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/point_location.h>

#include <functional>
#include <memory>
#include <vector>

namespace retroforge
{
  /// Bounds of a graded size field.
  struct SizeBounds
  {
    double smallest;       ///< [mm]
    double largest;        ///< [mm]
    double gradient = 0.3; ///< the size grows by at most this over a unit of distance, dimensionless

    /// Throws Error at `where` unless  0 < smallest <= largest  and  gradient > 0.
    void check(const std::string &where) const;
  };

  /// Wanted length of edges as a function of position: continuous, within its bounds, with |grad h| <=
  /// gradient everywhere. Usable as std::function<double(const Vec3 &)>; copies share their data.
  ///
  /// The field is trilinear on the leaves of a balanced forest of octrees, deal.II's hexahedral
  /// Triangulation, so that asking costs one descent whatever the wanted sizes cost. The serial class, not
  /// the distributed one: meshes are the same on every rank, every rank asks anywhere, and a field split
  /// between ranks would communicate at each question. The same input gives the same field on every rank.
  class GradedSize
  {
  public:
    /// The same size everywhere, without any tree.
    explicit GradedSize(double uniform);

    /// Nowhere larger than wanted at the points given and at the vertices of the trees, and smaller where the
    /// bound on the gradient asks for it. Trees are refined until a leaf is no longer than twice the size at
    /// its vertices, its centre and the points in it: give points where the size is small in little room.
    /// The growth away from small sizes is a bit direction-dependent, between gradient/sqrt(3) along the axes
    /// of the trees and gradient along their diagonals.
    /// @param region  where positions are expected; outside the closest point of it counts
    /// @param wanted  size at a point; is cut to the bounds
    GradedSize(const Box                                 &region,
               const std::function<double(const Vec3 &)> &wanted,
               const std::vector<Vec3>                   &points,
               const SizeBounds                          &bounds);

    double operator()(const Vec3 &x) const;

    /// Leaves of the trees, 0 when uniform.
    unsigned int n_leaves() const;

  private:
    class Forest;
    double                        uniform_;
    std::shared_ptr<const Forest> forest_;
  };
} // namespace retroforge
