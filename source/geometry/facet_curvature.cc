// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/geometry/facet_curvature.h>
#include <retroforge/geometry/vector_algebra.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    Vec3 normal(const TriangleSurface &surface, const unsigned int facet)
    {
      const auto &x = surface.vertices();
      const auto &t = surface.triangles()[facet];
      const Vec3  v = facet_vector(x[t[0]], x[t[1]], x[t[2]]);
      return v / v.norm();
    }

    /// Distance of the centroid from the line of an edge: a third of the height over it.
    double
    centroid_distance(const TriangleSurface &surface, const unsigned int facet, const unsigned int edge)
    {
      const auto &x = surface.vertices();
      const auto &t = surface.triangles()[facet];
      const Vec3  v = facet_vector(x[t[0]], x[t[1]], x[t[2]]), along = x[t[(edge + 1) % 3]] - x[t[edge]];
      return v.norm() / along.norm() / 3.;
    }

    double turn(const TriangleSurface &surface, const unsigned int facet, const unsigned int other)
    {
      return angle_between(normal(surface, facet), normal(surface, other));
    }
  } // namespace

  std::vector<double> facet_curvature(const TriangleSurface &surface, const double feature_angle)
  {
    std::vector<double> curvature(surface.n_facets(), 0.);
    for (unsigned int f = 0; f < surface.n_facets(); ++f)
      for (unsigned int e = 0; e < 3; ++e)
        if (const auto other = surface.neighbour(f, e); other.facet != invalid_index)
        {
          const double angle = turn(surface, f, other.facet);
          const double distance =
            centroid_distance(surface, f, e) + centroid_distance(surface, other.facet, other.edge);
          if (angle <= feature_angle * M_PI / 180.)
            curvature[f] = std::max(curvature[f], angle / distance);
        }
    return curvature;
  }

  std::vector<TriangleSurface::Edge> sharp_ridges(const TriangleSurface &surface, const double feature_angle)
  {
    std::vector<TriangleSurface::Edge> ridges;
    for (unsigned int f = 0; f < surface.n_facets(); ++f)
      for (unsigned int e = 0; e < 3; ++e)
        if (const auto other = surface.neighbour(f, e);
            other.facet != invalid_index && f < other.facet &&
            turn(surface, f, other.facet) > feature_angle * M_PI / 180.)
        {
          const Vec3 &a = surface.vertices()[surface.triangles()[f][e]],
                     &b = surface.vertices()[surface.triangles()[other.facet][(other.edge + 2) % 3]];
          if ((b - a) * normal(surface, f) < 0.) // the other facet falls away
            ridges.push_back({f, e});
        }
    return ridges;
  }

  std::vector<TriangleSurface::Edge> rim(const TriangleSurface &surface)
  {
    std::vector<TriangleSurface::Edge> edges;
    for (unsigned int f = 0; f < surface.n_facets(); ++f)
      for (unsigned int e = 0; e < 3; ++e)
        if (surface.neighbour(f, e).facet == invalid_index)
          edges.push_back({f, e});
    return edges;
  }
} // namespace retroforge
