// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/numbers.h>

#include <retroforge/core/dual.h>
#include <retroforge/core/error.h>
#include <retroforge/geometry/die_shapes.h>

#include <cmath>
#include <functional>
#include <optional>

/// @file
/// Rings around the z axis, of which dies by measures are made. For the files that make shapes alone.
namespace retroforge::die_rings
{
  inline constexpr double pi = dealii::numbers::PI, most_facets = 1e6;

  template <typename Number>
  struct Point2
  {
    Number x, y;
  };

  template <typename Number>
  using Points2 = std::vector<Point2<Number>>;

  /// Half of a sector of an outline, moved inwards: the ends included, always as many points.
  template <typename Number>
  using Outline = std::function<Points2<Number>(const Number &inwards)>;

  inline void
  require(const bool condition, const std::string &where, const std::string &what, const char *rule)
  {
    if (!condition)
      throw Error(where, what, rule, "change the measures so that they fit each other");
  }

  template <typename Number>
  void require_positive(const std::string &where, const std::string &name, const Number &x)
  {
    require(value_of(x) > 0., where + "/" + name, "is " + as_text(value_of(x)), "must be > 0");
  }

  template <typename Number>
  void require_draft(const std::string &where, const Number &draft)
  {
    require(value_of(draft) >= 0. && value_of(draft) < 80.,
            where + "/draft angle",
            "is " + as_text(value_of(draft)),
            "must be from 0 to 80 degrees");
  }

  /// Points of an arc at angles from..to about a centre; the first is left out if there are points before.
  template <typename Number>
  void append_arc(Points2<Number>      &points,
                  const Point2<Number> &centre,
                  const Number         &radius,
                  const Number         &from,
                  const Number         &to,
                  const unsigned int    n)
  {
    using std::cos;
    using std::sin;
    for (unsigned int i = points.empty() ? 0 : 1; i <= n; ++i)
    {
      const Number a = from + (to - from) * (double(i) / n);
      points.push_back({centre.x + radius * cos(a), centre.y + radius * sin(a)});
    }
  }

  /// (o, z) from the floor to the face, or from a punch's end up its side.
  template <typename Number>
  struct Section
  {
    Points2<Number> points;
    Number          reach_out = Number(0.); ///< reach of the edge, outwards on the face
    /// Reach of the fillet, inwards on the floor, or of a punch's edge on its end.
    Number reach_in = Number(0.);
  };

  template <typename Number>
  Section<Number> make_section(const std::string           &where,
                               const CavityProfile<Number> &profile,
                               const double                 chord_error,
                               Segments                    &segments)
  {
    using std::cos;
    using std::sin;
    using std::tan;
    require_positive(where, "depth", profile.depth);
    require_positive(where, "edge radius", profile.edge);
    require_positive(where, "fillet radius", profile.fillet);
    require_draft(where, profile.draft);
    const Number draft = profile.draft * (pi / 180.), turn = 0.5 * pi - draft, slope = tan(draft),
                 tangent = tan(Number(0.5 * turn));
    // The wall must be longer than the parts that the roundings take of it.
    require(value_of(Number(profile.depth / cos(draft))) >
              value_of(Number((profile.edge + profile.fillet) * tangent)),
            where,
            "edge radius and fillet radius take more than the whole wall",
            "a part of the wall must remain between them");
    Section<Number> section;
    section.reach_out           = profile.edge * tangent;
    section.reach_in            = profile.depth * slope + profile.fillet * tangent;
    const unsigned int n_fillet = segments(value_of(profile.fillet), value_of(turn), chord_error),
                       n_edge   = segments(value_of(profile.edge), value_of(turn), chord_error);
    for (unsigned int i = 0; i <= n_fillet; ++i)
    {
      const Number a = turn * (double(i) / n_fillet);
      section.points.push_back(
        {section.reach_in - profile.fillet * sin(a), -profile.depth + profile.fillet * (1. - cos(a))});
    }
    for (unsigned int i = n_edge + 1; i-- > 0;)
    {
      const Number a = turn * (double(i) / n_edge);
      section.points.push_back({-section.reach_out + profile.edge * sin(a), -profile.edge * (1. - cos(a))});
    }
    return section;
  }

  /// A half sector repeated around the axis, every second one mirrored; counter-clockwise.
  template <typename Number>
  Points2<Number> whole_ring(const Points2<Number> &half, const unsigned int n_halves)
  {
    const unsigned int m = half.size() - 1;
    Points2<Number>    ring;
    for (unsigned int s = 0; s < n_halves; ++s)
    {
      const bool   mirrored = s % 2 == 1;
      const double angle = 2. * pi / n_halves * (mirrored ? s + 1 : s), c = std::cos(angle),
                   d = std::sin(angle);
      for (unsigned int i = 0; i < m; ++i)
      {
        const Point2<Number> &p = half[mirrored ? m - i : i];
        const Number          y = mirrored ? Number(-p.y) : p.y;
        ring.push_back({c * p.x - d * y, d * p.x + c * y});
      }
    }
    return ring;
  }

  /// @param outer  radius of the face around a cavity [mm]; none: the section's last ring is the rim
  template <typename Number>
  ShapeMesh<Number> make_rings(const std::string           &where,
                               const Outline<Number>       &outline,
                               const Section<Number>       &section,
                               const std::optional<Number> &outer,
                               const unsigned int           n_halves)
  {
    using std::sqrt;
    const double n_facets =
      2. * section.points.size() * n_halves * (outline(section.points[0].x).size() - 1.);
    require(n_facets <= most_facets,
            where,
            "has " + as_text(n_facets) + " facets",
            "a die may have 1e6, and its `chord error' sets their number");
    ShapeMesh<Number> mesh;
    const auto        add = [&mesh](const Number &x, const Number &y, const Number &z) {
      Vector3<Number> v;
      v[0] = x;
      v[1] = y;
      v[2] = z;
      mesh.vertices.push_back(v);
    };
    add(Number(0.), Number(0.), section.points[0].y);
    unsigned int n = 0;
    for (const Point2<Number> &place : section.points)
    {
      const Points2<Number> ring = whole_ring(outline(place.x), n_halves);
      n                          = ring.size();
      for (const Point2<Number> &p : ring)
        add(p.x, p.y, place.y);
    }
    if (outer)
    {
      const std::size_t last = mesh.vertices.size() - n;
      for (unsigned int i = 0; i < n; ++i)
      {
        const Vector3<Number> v   = mesh.vertices[last + i];
        const Number          out = *outer / sqrt(Number(v[0] * v[0] + v[1] * v[1]));
        add(v[0] * out, v[1] * out, v[2]);
      }
    }
    const unsigned int m = n / n_halves;
    for (unsigned int i = 0; i < n; ++i)
      mesh.triangles.push_back({{0, 1 + i, 1 + (i + 1) % n}});
    for (unsigned int k = 0; k + (outer ? 0 : 1) < section.points.size(); ++k)
      for (unsigned int i = 0; i < n; ++i)
      {
        const unsigned int j = (i + 1) % n, a = 1 + k * n + i, b = 1 + (k + 1) * n + i,
                           c = 1 + (k + 1) * n + j, d = 1 + k * n + j;
        if (i / m % 2 == 0)
          mesh.triangles.insert(mesh.triangles.end(), {{{a, b, c}}, {{a, c, d}}});
        else
          mesh.triangles.insert(mesh.triangles.end(), {{{a, b, d}}, {{b, c, d}}});
      }
    return mesh;
  }
} // namespace retroforge::die_rings
