// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/geometry/closest_feature.h>
#include <retroforge/geometry/feature_projection.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    constexpr double tie = 1e-12; ///< of a squared distance

    struct Closest
    {
      DieFeature feature;
      double     squared_distance;
    };

    /// Closest point of the segment a, b: 0 and 1 are its ends.
    double parameter_on_segment(const Vec3 &X, const Vec3 &a, const Vec3 &b)
    {
      return std::clamp(((X - a) * (b - a)) / ((b - a) * (b - a)), 0., 1.);
    }

    Closest closest_of_facet(const TriangleSurface &surface, const unsigned int f, const Vec3 &X)
    {
      const Triangle                   &t = surface.triangles()[f];
      const std::array<const Vec3 *, 3> x{
        {&surface.vertices()[t[0]], &surface.vertices()[t[1]], &surface.vertices()[t[2]]}};
      const Vec3   v      = facet_vector(*x[0], *x[1], *x[2]);
      const double height = (X - *x[0]) * v / v.norm();
      bool         inside = true;
      Closest      best{{f, 0}, std::numeric_limits<double>::max()};
      for (unsigned char e = 0; e < 3; ++e)
      {
        const Vec3 &a = *x[e], &b = *x[(e + 1) % 3];
        // The side of the edge, looked at along the normal.
        if (facet_vector(a, b, X) * v >= 0.)
          continue;
        inside              = false;
        const double s      = parameter_on_segment(X, a, b);
        const double square = (X - a - s * (b - a)).norm_square();
        if (square < best.squared_distance)
          best = {{f,
                   static_cast<unsigned char>(s == 0.   ? 4 + e
                                              : s == 1. ? 4 + (e + 1) % 3
                                                        : 1 + e)},
                  square};
      }
      return inside ? Closest{{f, 0}, height * height} : best;
    }

    /// One name for an edge or vertex, whichever of its facets found it.
    DieFeature canonical(const TriangleSurface &surface, const DieFeature &feature)
    {
      if (feature.kind == 0)
        return feature;
      if (feature.kind >= 4)
      {
        const auto &first = surface.around(surface.triangles()[feature.facet][feature.kind - 4]).front();
        return {first.facet, static_cast<unsigned char>(4 + first.corner)};
      }
      const auto other = surface.neighbour(feature.facet, feature.kind - 1);
      if (other.facet < feature.facet)
        return {other.facet, static_cast<unsigned char>(1 + other.edge)};
      return feature;
    }

    bool before(const DieFeature &a, const DieFeature &b)
    {
      return a.facet != b.facet ? a.facet < b.facet : a.kind < b.kind;
    }

    /// Keeps what may still be the closest, whatever the order in which features come.
    class Candidates
    {
    public:
      explicit Candidates(const double within)
          : bound_(within < std::sqrt(std::numeric_limits<double>::max())
                     ? within * within
                     : std::numeric_limits<double>::max())
      {
      }

      double bound() const { return bound_; }

      void add(const Closest &next)
      {
        if (next.squared_distance > bound_ * (1. + tie))
          return;
        bound_ = std::min(bound_, next.squared_distance);
        candidates_.push_back(next);
      }

      DieFeature best(const TriangleSurface &surface) const
      {
        DieFeature best = DieFeature::none();
        for (const Closest &candidate : candidates_)
          if (candidate.squared_distance <= bound_ * (1. + tie))
          {
            const DieFeature feature = canonical(surface, candidate.feature);
            if (!best.found() || before(feature, best))
              best = feature;
          }
        return best;
      }

    private:
      double               bound_;
      std::vector<Closest> candidates_;
    };

    /// At the rim: the face when X is over it but for rounding, nothing when X is behind.
    DieFeature decide_at_rim(const TriangleSurface &surface, const DieFeature &feature, const Vec3 &X)
    {
      if (!is_rim(surface, feature))
        return feature;
      const auto [d, N]  = offset_and_normal(surface, feature, X);
      const double depth = d * N;
      if ((d - depth * N).norm() <= surface.rounding())
        return {feature.facet, 0};
      return depth < 0. ? DieFeature::none() : feature;
    }
  } // namespace

  ClosestFeature::ClosestFeature(const TriangleSurface &surface)
      : surface_(surface), tree_(boxes_of_facets(surface))
  {
  }

  DieFeature ClosestFeature::operator()(const Vec3 &X, const double within) const
  {
    Candidates   candidates(within);
    const double rounding = 1e-14 * X.norm();
    // What may still tie, distances being rounded.
    const auto bound = [&]() {
      const double distance = std::sqrt(candidates.bound()) * (1. + tie) + rounding;
      return distance * distance;
    };
    tree_.minimise([&](const unsigned int branch) { return tree_.box(branch).square_distance(X); },
                   [&](const unsigned int facet) {
                     candidates.add(closest_of_facet(surface_, facet, X));
                     return bound();
                   },
                   bound());
    const DieFeature feature = candidates.best(surface_);
    return feature.found() ? decide_at_rim(surface_, feature, X) : feature;
  }

  DieFeature closest_feature_of_all(const TriangleSurface &surface, const Vec3 &X, const double within)
  {
    Candidates candidates(within);
    for (unsigned int f = 0; f < surface.n_facets(); ++f)
      candidates.add(closest_of_facet(surface, f, X));
    const DieFeature feature = candidates.best(surface);
    return feature.found() ? decide_at_rim(surface, feature, X) : feature;
  }
} // namespace retroforge
