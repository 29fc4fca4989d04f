// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/geometry/surface_repair.h>
#include <retroforge/geometry/triangle_surface.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

namespace retroforge
{
  namespace
  {
    constexpr double crack_width = 1e-4; ///< of the diagonal

    Vec3 facet_vector_of(const TriangleSurface &surface, const unsigned int f)
    {
      const Triangle &t = surface.triangles()[f];
      const auto     &x = surface.vertices();
      return facet_vector(x[t[0]], x[t[1]], x[t[2]]);
    }

    std::string facet_name(const unsigned int f)
    {
      return "facet " + std::to_string(f + 1);
    }

    std::string at(const Vec3 &x)
    {
      std::ostringstream text;
      text << "(" << x[0] << ", " << x[1] << ", " << x[2] << ")";
      return text.str();
    }

    /// An edge of the rim, by its vertices.
    struct RimEdge
    {
      unsigned int a, b;
    };

    double distance_to_segment(const Vec3 &x, const Vec3 &a, const Vec3 &b)
    {
      const Vec3   e = b - a;
      const double t = std::clamp(((x - a) * e) / (e * e), 0., 1.);
      return (x - a - t * e).norm();
    }
  } // namespace

  TriangleSurface::TriangleSurface(const std::string    &where,
                                   NodalVectors<double>  vertices,
                                   std::vector<Triangle> triangles)
      : vertices_(std::move(vertices)), triangles_(std::move(triangles))
  {
    if (triangles_.empty())
      throw Error(where, "has no facets", "a surface needs at least one", "export the part's surface anew");
    check_facets(where);
    box_ = bounding_box(vertices_);
    // A length that does not follow small changes of the vertices, which derivatives would have to know.
    made_diagonal_ = std::exp2(std::round(std::log2(diagonal())));
    connect(where);
    check_folds(where);
    check_cracks(where);
  }

  void TriangleSurface::move_vertices(NodalVectors<double> vertices)
  {
    vertices_ = std::move(vertices);
    box_      = bounding_box(vertices_);
  }

  bool TriangleSurface::is_closed() const
  {
    return std::none_of(on_rim_.begin(), on_rim_.end(), [](const bool rim) { return rim; });
  }

  void TriangleSurface::check_facets(const std::string &where) const
  {
    std::map<Triangle, unsigned int> known;
    for (unsigned int f = 0; f < n_facets(); ++f)
    {
      Triangle t       = triangles_[f];
      double   longest = 0.;
      for (unsigned int c = 0; c < 3; ++c)
      {
        if (t[c] >= vertices_.size() || !std::isfinite(vertices_[t[c]].norm()))
          throw Error(where,
                      facet_name(f) + " has a corner without a finite position",
                      "all corners must be given",
                      "export the part's surface anew");
      }
      for (unsigned int c = 0; c < 3; ++c)
        longest = std::max(longest, (vertices_[t[(c + 1) % 3]] - vertices_[t[c]]).norm());
      if (!(facet_vector_of(*this, f).norm() > least_facet_height * longest * longest))
        throw Error(where,
                    facet_name(f) + " at " + at(vertices_[t[0]]) + " has no area",
                    "a facet's corners must be distinct and not on a line",
                    "remove such facets with a mesh repair tool, or export anew with a finer tolerance");
      std::sort(t.begin(), t.end());
      const auto [first, is_new] = known.insert({t, f});
      if (!is_new)
        throw Error(where,
                    facet_name(f) + " at " + at(vertices_[t[0]]) + " has the corners of " +
                      facet_name(first->second),
                    "a facet must be there once",
                    "remove duplicates with a mesh repair tool, or export one body only");
    }
  }

  void TriangleSurface::connect(const std::string &where)
  {
    std::map<std::pair<unsigned int, unsigned int>, std::vector<Edge>> edges; // by vertices, lower first
    around_.resize(vertices_.size());
    on_rim_.assign(vertices_.size(), false);
    for (unsigned int f = 0; f < n_facets(); ++f)
      for (unsigned int e = 0; e < 3; ++e)
      {
        const unsigned int a = triangles_[f][e], b = triangles_[f][(e + 1) % 3];
        edges[std::minmax(a, b)].push_back({f, e});
        around_[a].push_back({f, e});
      }
    neighbours_.assign(n_facets(), {{{invalid_index, 0}, {invalid_index, 0}, {invalid_index, 0}}});
    for (const auto &[ends, sides] : edges)
    {
      if (sides.size() > 2)
        throw Error(where,
                    "the edge from " + at(vertices_[ends.first]) + " to " + at(vertices_[ends.second]) +
                      " belongs to " + std::to_string(sides.size()) + " facets",
                    "at most two facets may meet at an edge",
                    "export one body without inner walls");
      if (sides.size() == 1)
      {
        on_rim_[ends.first] = on_rim_[ends.second] = true;
        continue;
      }
      // Facets of one orientation run along their common edge in opposite directions.
      if (triangles_[sides[0].facet][sides[0].edge] == triangles_[sides[1].facet][sides[1].edge])
        throw Error(where,
                    facet_name(sides[0].facet) + " and " + facet_name(sides[1].facet) + " at " +
                      at(vertices_[ends.first]) + " have opposite orientations",
                    "all facets must show the same side to the workpiece",
                    "orient the facets consistently with a mesh repair tool");
      neighbours_[sides[0].facet][sides[0].edge] = sides[1];
      neighbours_[sides[1].facet][sides[1].edge] = sides[0];
    }
  }

  void TriangleSurface::check_folds(const std::string &where) const
  {
    for (unsigned int f = 0; f < n_facets(); ++f)
      for (const Edge &other : neighbours_[f])
        if (other.facet != invalid_index && other.facet > f)
        {
          const Vec3 a = facet_vector_of(*this, f), b = facet_vector_of(*this, other.facet);
          if ((a / a.norm() + b / b.norm()).norm() < 1e-3)
            throw Error(where,
                        facet_name(f) + " and " + facet_name(other.facet) + " at " +
                          at(vertices_[triangles_[f][0]]) + " are folded onto each other",
                        "an edge must have an outer and an inner side",
                        "remove the fold with a mesh repair tool");
        }
  }

  void TriangleSurface::check_cracks(const std::string &where) const
  {
    const double                                        width = crack_width * diagonal();
    std::vector<unsigned int>                           rim; // vertices, by x
    std::vector<RimEdge>                                edges;
    std::map<unsigned int, std::array<unsigned int, 2>> next_to; // of a rim vertex: before and after
    for (unsigned int v = 0; v < vertices_.size(); ++v)
      if (on_rim_[v])
        rim.push_back(v);
    std::sort(rim.begin(), rim.end(), [this](const unsigned int a, const unsigned int b) {
      return std::make_pair(vertices_[a][0], a) < std::make_pair(vertices_[b][0], b);
    });
    for (unsigned int f = 0; f < n_facets(); ++f)
      for (unsigned int e = 0; e < 3; ++e)
        if (neighbours_[f][e].facet == invalid_index)
        {
          const unsigned int a = triangles_[f][e], b = triangles_[f][(e + 1) % 3];
          edges.push_back({a, b});
          next_to.try_emplace(b, std::array<unsigned int, 2>{{b, b}}).first->second[0] = a;
          next_to.try_emplace(a, std::array<unsigned int, 2>{{a, a}}).first->second[1] = b;
        }
    for (const RimEdge &edge : edges)
    {
      const Vec3 &a = vertices_[edge.a], &b = vertices_[edge.b];
      auto        v = std::lower_bound(rim.begin(),
                                rim.end(),
                                std::min(a[0], b[0]) - width,
                                [this](const unsigned int i, const double x) { return vertices_[i][0] < x; });
      for (; v != rim.end() && vertices_[*v][0] <= std::max(a[0], b[0]) + width; ++v)
      {
        if (*v == edge.a || *v == edge.b || distance_to_segment(vertices_[*v], a, b) >= width)
          continue;
        // The edges next to a vertex's own are near it where those are short.
        const auto  &beside    = next_to.at(*v);
        const auto   is_beside = [&](const unsigned int end) { return end == beside[0] || end == beside[1]; };
        const double to_ends   = std::min((vertices_[*v] - a).norm(), (vertices_[*v] - b).norm());
        if (!(is_beside(edge.a) || is_beside(edge.b)) || to_ends >= width)
          throw Error(where,
                      "there is a crack at " + at(vertices_[*v]) + ", narrower than " + as_text(width),
                      "facets that meet must share their vertices",
                      "close it with a mesh repair tool, or export anew with a finer tolerance");
      }
    }
  }

  std::pair<Vec3, Vec3> bounding_box(const NodalVectors<double> &points)
  {
    std::pair<Vec3, Vec3> box{points.at(0), points.at(0)};
    for (const Vec3 &x : points)
      for (unsigned int i = 0; i < 3; ++i)
      {
        box.first[i]  = std::min(box.first[i], x[i]);
        box.second[i] = std::max(box.second[i], x[i]);
      }
    return box;
  }

  std::vector<BoundingBox> boxes_of_facets(const TriangleSurface &surface)
  {
    std::vector<BoundingBox> boxes;
    boxes.reserve(surface.n_facets());
    for (const Triangle &corners : surface.triangles())
    {
      boxes.emplace_back(surface.vertices()[corners[0]]);
      boxes.back().include(surface.vertices()[corners[1]]);
      boxes.back().include(surface.vertices()[corners[2]]);
    }
    return boxes;
  }

  double enclosed_volume(const TriangleSurface &surface)
  {
    double six_fold = 0.;
    for (unsigned int f = 0; f < surface.n_facets(); ++f)
      six_fold += surface.vertices()[surface.triangles()[f][0]] * facet_vector_of(surface, f);
    return six_fold / 6.;
  }

  Vec3 mean_normal(const TriangleSurface &surface)
  {
    Vec3        sum;
    double      area = 0.;
    const auto &x    = surface.vertices();
    for (const Triangle &facet : surface.triangles())
    {
      const Vec3 vector = facet_vector(x[facet[0]], x[facet[1]], x[facet[2]]);
      sum += vector;
      area += vector.norm();
    }
    return sum / area;
  }
} // namespace retroforge
