// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/die_overlap.h>
#include <retroforge/contact/facet_corners.h>
#include <retroforge/core/shares.h>
#include <retroforge/geometry/vector_algebra.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    /// Keeps the deepest place; of equally deep ones the first, whatever their rounding.
    void keep_deepest(const double depth, const Vec3 &place, const bool is_of_die, Overlap &overlap)
    {
      if (depth > (1. + 1e-9) * overlap.depth)
        overlap = {depth, place, is_of_die};
    }

    bool is_in(const BoundingBox &box, const Vec3 &x)
    {
      return box.square_distance(x) == 0.;
    }

    /// A point of a die's facets in the metal.
    struct DiePoint
    {
      Vec3               x;
      MetalSurface::Foot foot;
      double depth; ///< of the smooth surface there, which may be farther out than the facets [mm]
    };

    /// `use(point)` where a point of the die's facets is in the metal.
    template <typename Use>
    void if_in_metal(const Die          &die,
                     const Vec3         &displacement,
                     const MetalSurface &metal,
                     const Vec3         &x,
                     const Use          &use)
    {
      if (!is_in(metal.box(), x) || metal.is_beyond(x))
        return;
      const MetalSurface::Foot foot  = metal.closest(x);
      const double             depth = -foot.distance - metal.hollow(foot.triangle);
      if (!(depth > metal.rounding()))
        return;
      const double recess = die.signed_distance(x, displacement);
      if (const double left = depth - (std::isfinite(recess) ? std::max(0., recess) : 0.); left > 0.)
        use(DiePoint{x, foot, left});
    }

    /// Returns the points where the segment a, b crosses faces of the metal: parts of its length, ascending,
    /// its ends included.
    std::vector<double> crossings(const MetalSurface &metal, const Vec3 &a, const Vec3 &b)
    {
      std::vector<double> at = {0., 1.};
      BoundingBox         box(a);
      box.include(b);
      for (const unsigned int t : metal.tree().intersecting(box))
      {
        const Corners p    = metal.corners(t);
        const Vec3    n    = facet_vector(p[0], p[1], p[2]);
        const double  from = (a - p[0]) * n, to = (b - p[0]) * n;
        if (!((from > 0. && to < 0.) || (from < 0. && to > 0.)))
          continue;
        const double s = from / (from - to);
        const Vec3   x = a + s * (b - a);
        if (facet_vector(p[0], p[1], x) * n >= 0. && facet_vector(p[1], p[2], x) * n >= 0. &&
            facet_vector(p[2], p[0], x) * n >= 0.)
          at.push_back(s);
      }
      std::sort(at.begin(), at.end());
      return at;
    }

    /// `use(point)` of each vertex of the die in the metal, and of points of its edges that go through faces.
    template <typename Use>
    void for_each_die_point(const Die          &die,
                            const Vec3         &displacement,
                            const MetalSurface &metal,
                            MPI_Comm            comm,
                            const Use          &use)
    {
      constexpr unsigned int n_samples = 8;
      const TriangleSurface &surface   = *die.surface();
      const auto [begin, end]          = share_of_rank(surface.vertices().size(), comm);
      for (std::size_t v = begin; v < end; ++v)
        if_in_metal(die, displacement, metal, surface.vertices()[v] + displacement, use);
      const auto [first, last] = share_of_rank(surface.n_facets(), comm);
      for (unsigned int f = first; f < last; ++f)
      {
        const Corners p = facet_corners(surface, f, displacement);
        if (!BoundingBox(p).intersects(metal.box()))
          continue;
        for (unsigned int e = 0; e < 3; ++e)
        {
          if (const unsigned int other = surface.neighbour(f, e).facet; other != invalid_index && other < f)
            continue;
          const Vec3 &a = p[e], &b = p[(e + 1) % 3];
          const auto  at = crossings(metal, a, b);
          for (std::size_t i = 1; at.size() > 2 && i < at.size(); ++i)
            for (unsigned int k = 1; k < n_samples; ++k)
              if_in_metal(die,
                          displacement,
                          metal,
                          a + (at[i - 1] + (at[i] - at[i - 1]) * (double(k) / n_samples)) * (b - a),
                          use);
        }
      }
    }
  } // namespace

  Overlap
  find_die_in_metal(const Die &die, const Vec3 &displacement, const MetalSurface &metal, MPI_Comm comm)
  {
    Overlap overlap;
    if (die.surface())
      for_each_die_point(die, displacement, metal, comm, [&](const DiePoint &point) {
        keep_deepest(point.depth, point.x, true, overlap);
      });
    return overlap;
  }

  std::optional<UnseenPart> find_unseen(const Die &die, const Vec3 &displacement, const MetalSurface &metal)
  {
    std::optional<UnseenPart> unseen;
    if (!die.surface())
      return unseen;
    const auto sees = [&](const unsigned int triangle) {
      const Corners p = metal.corners(triangle);
      for (unsigned int c = 0; c < 3; ++c)
        for (const Vec3 &x : {p[c], Vec3(0.5 * (p[c] + p[(c + 1) % 3]))})
          if (die.signed_distance(x, displacement) < 0.)
            return true;
      return false;
    };
    for_each_die_point(die, displacement, metal, MPI_COMM_SELF, [&](const DiePoint &point) {
      if (unseen && point.depth <= unseen->depth)
        return;
      // Where it comes in, it is as wide as it is from there to its sides.
      const double width = -2. * die.facet_distance(point.foot.place, displacement);
      if (width > 0. && !sees(point.foot.triangle))
        unseen = {point.depth, width, point.foot.place};
    });
    return unseen;
  }

  Overlap find_overlap(const Die &die, const Vec3 &displacement, const MetalSurface &metal)
  {
    Overlap overlap;
    for (const Vec3 &x : metal.vertices())
      if (const double depth = -die.facet_distance(x, displacement);
          depth > std::max(overlap.depth, metal.rounding()))
        keep_deepest(std::min(depth, -die.signed_distance(x, displacement)), x, false, overlap);
    const Overlap of_die = find_die_in_metal(die, displacement, metal);
    return of_die.depth > overlap.depth ? of_die : overlap;
  }
} // namespace retroforge
