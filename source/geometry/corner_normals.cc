// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/geometry/corner_normals.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    // Facets that turn by less lie in one plane: files in single precision have no more digits [radians].
    constexpr double flat_angle = 1e-3;
    // Flat regions smaller than this part of a fan's largest do not bend its normal.
    constexpr double least_region = 0.3;

    std::vector<Vec3> facet_vectors(const TriangleSurface &surface)
    {
      const auto       &x = surface.vertices();
      std::vector<Vec3> vectors;
      for (const Triangle &t : surface.triangles())
        vectors.push_back(facet_vector(x[t[0]], x[t[1]], x[t[2]]));
      return vectors;
    }

    /// Area of the flat region each facet is part of, as a sum of the lengths of the facets' vectors.
    std::vector<double> region_areas(const TriangleSurface &surface, const std::vector<Vec3> &vectors)
    {
      std::vector<double>       area(vectors.size(), -1.);
      std::vector<unsigned int> region;
      for (unsigned int first = 0; first < vectors.size(); ++first)
      {
        if (area[first] >= 0.)
          continue;
        region      = {first};
        area[first] = 0.;
        double sum  = 0.;
        for (std::size_t i = 0; i < region.size(); ++i)
        {
          sum += vectors[region[i]].norm();
          for (unsigned int e = 0; e < 3; ++e)
            if (const unsigned int next = surface.neighbour(region[i], e).facet;
                next != invalid_index && area[next] < 0. &&
                angle_between(vectors[first], vectors[next]) < flat_angle)
            {
              area[next] = 0.;
              region.push_back(next);
            }
        }
        for (const unsigned int f : region)
          area[f] = sum;
      }
      return area;
    }
    /// Returns the distance from a facet of a smooth surface that turns by the angle over the narrower one of
    /// two facets.
    double sagitta(const TriangleSurface   &surface,
                   const std::vector<Vec3> &vectors,
                   const unsigned int       f,
                   const unsigned int       e,
                   const unsigned int       other,
                   const double             angle)
    {
      const Triangle &t     = surface.triangles()[f];
      const double    along = (surface.vertices()[t[(e + 1) % 3]] - surface.vertices()[t[e]]).norm();
      return std::min(vectors[f].norm(), vectors[other].norm()) / along * angle / 8.;
    }
  } // namespace

  CornerNormals::CornerNormals(const TriangleSurface &surface,
                               const double           feature_angle,
                               const double           largest_sagitta)
      : normal_of_corner_(surface.n_facets(), {{invalid_index, invalid_index, invalid_index}})
      , sharp_(surface.n_facets())
      , on_sharp_edge_(surface.vertices().size(), false)
  {
    const std::vector<Vec3> vectors = facet_vectors(surface);
    for (unsigned int f = 0; f < surface.n_facets(); ++f)
      for (unsigned int e = 0; e < 3; ++e)
      {
        const unsigned int other = surface.neighbour(f, e).facet;
        const double       angle = other == invalid_index ? M_PI : angle_between(vectors[f], vectors[other]);
        sharp_[f][e]             = angle > feature_angle * M_PI / 180. ||
                       sagitta(surface, vectors, f, e, other, angle) > largest_sagitta * surface.diagonal();
        if (sharp_[f][e])
          for (const unsigned int end : {e, (e + 1) % 3})
            on_sharp_edge_[surface.triangles()[f][end]] = true;
      }
    const std::vector<double> area = region_areas(surface, vectors);
    for (unsigned int f = 0; f < surface.n_facets(); ++f)
      for (unsigned int c = 0; c < 3; ++c)
      {
        if (normal_of_corner_[f][c] != invalid_index)
          continue;
        // The fan: all facets that are reached from f around the vertex without crossing a sharp edge.
        std::vector<TriangleSurface::Corner> fan = {{f, c}};
        normal_of_corner_[f][c]                  = corners_.size();
        double largest                           = 0.;
        for (std::size_t i = 0; i < fan.size(); ++i)
        {
          largest = std::max(largest, area[fan[i].facet]);
          for (const unsigned int e : {fan[i].corner, (fan[i].corner + 2) % 3})
            if (!sharp_[fan[i].facet][e])
            {
              const auto         next   = surface.neighbour(fan[i].facet, e);
              const unsigned int vertex = surface.triangles()[f][c];
              const Triangle    &t      = surface.triangles()[next.facet];
              const unsigned int corner = std::find(t.begin(), t.end(), vertex) - t.begin();
              if (normal_of_corner_[next.facet][corner] == invalid_index)
              {
                normal_of_corner_[next.facet][corner] = corners_.size();
                fan.push_back({next.facet, corner});
              }
            }
        }
        fan.erase(std::remove_if(fan.begin(),
                                 fan.end(),
                                 [&](const TriangleSurface::Corner &at) {
                                   return area[at.facet] < least_region * largest;
                                 }),
                  fan.end());
        std::sort(fan.begin(), fan.end(), [](const auto &a, const auto &b) { return a.facet < b.facet; });
        corners_.push_back(fan);
      }
    update(surface);
  }

  void CornerNormals::update(const TriangleSurface &surface)
  {
    values_.resize(corners_.size());
    for (unsigned int n = 0; n < corners_.size(); ++n)
      values_[n] = normal<double>(surface, surface.vertices(), n);
  }

  void CornerNormals::reverse_normal(const TriangleSurface &surface,
                                     const unsigned int     normal,
                                     const Vec3            &normal_bar,
                                     NodalVectors<double>  &x_bar) const
  {
    const auto &x    = surface.vertices();
    const auto  edge = [&](const TriangleSurface::Corner &at, const unsigned int e) {
      const Triangle &t = surface.triangles()[at.facet];
      return x[t[(at.corner + e) % 3]] - x[t[at.corner]];
    };
    Vec3 sum;
    for (const auto &at : corners_[normal])
    {
      const Vec3 u = edge(at, 1), v = edge(at, 2);
      sum += cross(u, v) / ((u * u) * (v * v));
    }
    const Vec3 sum_bar = reverse_unit(sum, normal_bar);
    for (const auto &at : corners_[normal])
    {
      const Vec3   u = edge(at, 1), v = edge(at, 2);
      const double scale = 1. / ((u * u) * (v * v)), scale_bar = cross(u, v) * sum_bar;
      const Vec3   w_bar = scale * sum_bar;
      const Vec3   u_bar = cross(v, w_bar) - 2. * scale * scale_bar / (u * u) * u,
                 v_bar   = cross(w_bar, u) - 2. * scale * scale_bar / (v * v) * v;
      const Triangle &t  = surface.triangles()[at.facet];
      x_bar[t[(at.corner + 1) % 3]] += u_bar;
      x_bar[t[(at.corner + 2) % 3]] += v_bar;
      x_bar[t[at.corner]] -= u_bar + v_bar;
    }
  }
} // namespace retroforge
