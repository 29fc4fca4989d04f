// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/level_gaps.h>
#include <retroforge/core/shares.h>
#include <retroforge/mesh/surface_areas.h>
#include <retroforge/objective/facet_gaps.h>
#include <retroforge/objective/local_derivatives.h>

#include <map>

namespace retroforge
{
  namespace
  {
    /// 0 for t <= 0, 1 for t >= 1, twice differentiable: one minus the friction ramp.
    template <typename Number>
    Number step(const Number &t)
    {
      if (value_of(t) <= 0.)
        return Number(0.);
      if (value_of(t) >= 1.)
        return Number(1.);
      return t * t * t * (10. + t * (-15. + 6. * t));
    }

    /// 1 for x <= from, 0 for x >= to.
    template <typename Number>
    Number fall(const Number &x, const double from, const double to)
    {
      return 1. - step(Number((x - from) / (to - from)));
    }

    /// x+
    template <typename Number>
    Number positive_part(const Number &x, const Number &rounding)
    {
      return x * step(Number(x / rounding));
    }

    /// 1 - cos of the turns up to which a die counts as smooth, and from which on as sharp.
    const double smooth_turn = 1. - std::cos(25. * dealii::numbers::PI / 180.),
                 sharp_turn  = 1. - std::cos(45. * dealii::numbers::PI / 180.);

    constexpr double at_corner = 1. / 20., at_middle = 2. / 15., at_centre = 9. / 20.;

    /// Gap over l of a corner that is off the die.
    constexpr double off_the_die = 0.05;

    /// Part of l over which x+ is rounded.
    constexpr double rounding_of_size = 1e-3;
  } // namespace

  void FacetAtDie::add_points(const std::array<Vec3, 7> &points_bar, std::array<Vec3, 3> &x_bar)
  {
    for (unsigned int k = 0; k < 3; ++k)
    {
      x_bar[k] += points_bar[k] + points_bar[6] / 3.;
      x_bar[k] += 0.5 * (points_bar[3 + k] + points_bar[3 + (k + 2) % 3]);
    }
  }

  std::vector<FacetAtDie>
  find_facets_at_die(const FinalView<double> &view, const Die &die, const Vec3 &displacement, const Box &box)
  {
    const auto triangles    = surface_triangles(view.scene.mesh);
    const auto [begin, end] = share_of_rank(triangles.size(), view.scene.discretization.comm());
    using Place             = std::array<NodeIndex, 2>;
    std::map<Place, DieFeature> seen; // corners and middles are points of several facets
    std::vector<FacetAtDie>     facets;
    double                      reach = 0.;
    for (const Triangle &t : triangles)
      for (unsigned int k = 0; k < 3; ++k)
        reach = std::max(reach, 2. * (view.X[t[(k + 1) % 3]] - view.X[t[k]]).norm());
    for (std::size_t f = begin; f < end; ++f)
    {
      FacetAtDie          facet{triangles[f], {}};
      std::array<Vec3, 3> x;
      double              longest = 0.;
      for (unsigned int k = 0; k < 3; ++k)
        x[k] = view.X[facet.nodes[k]];
      for (unsigned int k = 0; k < 3; ++k)
        longest = std::max(longest, (x[(k + 1) % 3] - x[k]).norm());
      const BoundingBox around(x);
      bool              beside = false;
      for (unsigned int i = 0; i < 3; ++i)
        beside = beside || around.upper[i] < box.first[i] || around.lower[i] > box.second[i];
      if (beside)
        continue;
      const auto points = FacetAtDie::points(x);
      const auto look   = [&](const unsigned int q) {
        if (q == 6)
          return die.closest(points[q], displacement, reach);
        const NodeIndex a = facet.nodes[q % 3], b = q < 3 ? a : facet.nodes[(q + 1) % 3];
        const auto [at, is_new] = seen.try_emplace(Place{{std::min(a, b), std::max(a, b)}});
        if (is_new)
          at->second = die.closest(points[q], displacement, reach);
        return at->second;
      };
      double nearest = std::numeric_limits<double>::max();
      for (unsigned int q = 0; q < 3; ++q)
        if ((facet.features[q] = look(q)).found())
          nearest = std::min(nearest, die.project(points[q], displacement, facet.features[q]).delta);
      if (nearest > longest)
        continue;
      for (unsigned int q = 3; q < 7; ++q)
        facet.features[q] = look(q);
      if (std::all_of(facet.features.begin(), facet.features.end(), [](const DieFeature &feature) {
            return feature.found();
          }))
        facets.push_back(facet);
    }
    return facets;
  }

  template <typename Number>
  Number
  volume_at_facet(const std::array<Vector3<Number>, 3> &x, const FacetGaps<Number> &gaps, const bool behind)
  {
    using std::sqrt;
    const Vector3<Number> v      = cross<Number>(x[1] - x[0], x[2] - x[0]);
    const Number          twice  = length(v);
    const Number          size   = sqrt(twice);
    const Number          r      = rounding_of_size * size;
    const auto           &d      = gaps.delta;
    const Number          ends   = d[0] + d[1] + d[2];
    const Number          mean   = at_corner * ends + at_middle * (d[3] + d[4] + d[5]) + at_centre * d[6];
    const Number          corner = ends / 3., bulge = mean - corner;
    const auto            along = [&](const Vector3<Number> &n) {
      return fall(Number(1. - Number(v * n) / twice), smooth_turn, sharp_turn);
    };
    Number weight = fall(Number(bulge / size), smooth_bulge, sharp_bulge) *
                    fall(Number(corner / size), 0., 1.) * along(gaps.n[3]);
    for (unsigned int k = 0; k < 3; ++k)
      weight *= 1. - (1. - along(gaps.n[k])) * step(Number(d[k] / (off_the_die * size)));
    const Number counted = positive_part(Number(mean - weight * positive_part(bulge, r)), r);
    const Number between = behind ? mean : positive_part(mean, r);
    return 0.5 * twice * (between - counted);
  }

  template <typename Number>
  Number share_of_facet(const std::array<Vector3<Number>, 3> &x,
                        const std::vector<HalfSpace<Number>> &half_spaces)
  {
    const Vector3<Number> v = cross<Number>(x[1] - x[0], x[2] - x[0]);
    return 2. * Number(clipped_area(x, half_spaces.data(), half_spaces.data() + half_spaces.size()) * v) /
           Number(v * v);
  }

  template <typename Number>
  Number volume_of_bulge(const std::array<Vector3<Number>, 3> &x, const std::array<Number, 3> &delta)
  {
    return length(cross<Number>(x[1] - x[0], x[2] - x[0])) * (delta[0] + delta[1] + delta[2]) / 6.;
  }

#define RETROFORGE_INSTANTIATE(Number)                                                                      \
  template Number volume_at_facet(const std::array<Vector3<Number>, 3> &, const FacetGaps<Number> &, bool); \
  template Number share_of_facet(const std::array<Vector3<Number>, 3> &,                                    \
                                 const std::vector<HalfSpace<Number>> &);                                   \
  template Number volume_of_bulge(const std::array<Vector3<Number>, 3> &, const std::array<Number, 3> &);
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
  RETROFORGE_INSTANTIATE(Partials<n_partials>)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
