// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/geometry/surface_rims.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    using Edge = TriangleSurface::Edge;

    /// The edge of the rim that begins where one of it ends: around that vertex, from facet to facet.
    Edge next_of_rim(const TriangleSurface &surface, const Edge &edge)
    {
      Edge next = {edge.facet, (edge.edge + 1) % 3};
      for (Edge other = surface.neighbour(next.facet, next.edge); other.facet != invalid_index;
           other      = surface.neighbour(next.facet, next.edge))
        next = {other.facet, (other.edge + 1) % 3};
      return next;
    }
  } // namespace

  std::vector<SurfaceRim> find_rims(const TriangleSurface &surface)
  {
    std::vector<SurfaceRim>          rims;
    std::vector<std::array<bool, 3>> visited(surface.n_facets(), {{false, false, false}});
    for (unsigned int f = 0; f < surface.n_facets(); ++f)
      for (unsigned int e = 0; e < 3; ++e)
      {
        SurfaceRim rim;
        for (Edge at = {f, e};
             surface.neighbour(at.facet, at.edge).facet == invalid_index && !visited[at.facet][at.edge];
             at = next_of_rim(surface, at))
        {
          visited[at.facet][at.edge] = true;
          const Triangle &facet      = surface.triangles()[at.facet];
          const Vec3     &begin      = surface.vertices()[facet[at.edge]];
          ++rim.n_edges;
          rim.length += (surface.vertices()[facet[(at.edge + 1) % 3]] - begin).norm();
          rim.centre += begin;
        }
        if (rim.n_edges > 0)
        {
          rim.centre /= rim.n_edges;
          rims.push_back(rim);
        }
      }
    std::stable_sort(
      rims.begin(), rims.end(), [](const SurfaceRim &a, const SurfaceRim &b) { return a.length > b.length; });
    return rims;
  }
} // namespace retroforge
