// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/box_tree.h>
#include <retroforge/geometry/triangle_surface.h>

#include <functional>
#include <limits>
#include <type_traits>
#include <utility>

namespace retroforge
{
  /// Bounds between which a wanted length is needed exactly. Where it is smaller than `lower`, any value
  /// smaller than that will do; where it is larger than `upper`, any that is not smaller than that. Remeshing
  /// mostly needs to know whether an edge is too long or too short, which a search answers much sooner.
  struct SizeQuery
  {
    double lower = 0., upper = std::numeric_limits<double>::max();
  };

  /// Wanted edge length at a position [length].
  class SizeField
  {
  public:
    /// @param of  a function of the position, or of the position and a SizeQuery
    template <typename F, typename = std::enable_if_t<!std::is_base_of_v<SizeField, std::decay_t<F>>>>
    SizeField(F of)
    {
      if constexpr (std::is_invocable_v<F, const Vec3 &, const SizeQuery &>)
        of_ = std::move(of);
      else
        of_ = [of = std::move(of)](const Vec3 &x, const SizeQuery &) { return of(x); };
    }

    double operator()(const Vec3 &x) const { return of_(x, {}); }

    /// The smaller of the wanted length at x and query.upper, as exact as the query asks.
    double at_most(const Vec3 &x, const SizeQuery &query) const
    {
      return std::min(of_(x, query), query.upper);
    }

    /// Returns whether the wanted length at x is smaller than `bound`.
    bool below(const Vec3 &x, const double bound) const { return of_(x, {bound, bound}) < bound; }

  private:
    std::function<double(const Vec3 &, const SizeQuery &)> of_;
  };

  /// Wanted length of edges near a surface, each facet f of which has a wanted length s_f of its own:
  ///
  ///   h(x) = min( h_0, min_f ( s_f + g |x - f| ) ),    |x - f| the distance of x to the facet,
  ///
  /// the largest function that is nowhere above h_0, on no facet above its s_f, and changes by at most g per
  /// distance. It moves with the surface, so that h(x - displacement) serves all positions of a die.
  ///
  /// Nothing is tabulated: an evaluation is a branch-and-bound search among the facets with s_f < h_0. (An
  /// octree that holds the same field is faster to evaluate, but a remeshing needs too few evaluations to pay
  /// for making it.)
  class GradedSize
  {
  public:
    /// @param size_of_facet  s_f [mm]
    /// @param largest        h_0 [mm]
    /// @param growth         g, dimensionless
    /// @param ridges         edges that want a length of their own
    /// Throws Error unless all of them are positive and there is one size per facet.
    GradedSize(const TriangleSurface                    &surface,
               const std::vector<double>                &size_of_facet,
               double                                    largest,
               double                                    growth,
               const std::vector<TriangleSurface::Edge> &ridges         = {},
               double                                    size_of_ridges = 0.);

    double operator()(const Vec3 &x, const SizeQuery &query = {}) const;

    /// Facets with s_f < h_0.
    unsigned int n_facets() const { return facets_.size(); }

  private:
    double                           largest_, growth_;
    std::vector<std::array<Vec3, 3>> facets_; ///< only those with s_f < h_0
    std::vector<double>              size_;   ///< s_f of those
    BoxTree                          tree_;
    std::vector<double>              least_; ///< smallest s_f in each branch of the tree
  };
} // namespace retroforge
