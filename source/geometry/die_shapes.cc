// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/geometry/die_rings.templates.h>

namespace retroforge
{
  using namespace die_rings;

  unsigned int Segments::operator()(const double radius, const double angle, const double error)
  {
    if (next_ == n_.size())
      n_.push_back(
        error >= radius ? 1 : std::max(1., std::ceil(angle / (2. * std::acos(1. - error / radius)) - 1e-9)));
    return n_[next_++];
  }

  template <typename Number>
  ShapeMesh<Number> shape_mesh(const std::string         &where,
                               const TripodShape<Number> &shape,
                               const double               chord_error,
                               Segments                  &segments)
  {
    const double error = 0.5 * chord_error; // chords in plan and in section add up
    using std::atan2;
    using std::sqrt;
    const auto   section = make_section(where, shape.profile, error, segments);
    const Number b = 0.5 * shape.width, in = section.reach_in, out = section.reach_out;
    const double hub = value_of(shape.hub), half = value_of(b), corner = value_of(shape.corner);
    require(half > value_of(in),
            where + "/arm width",
            "is " + as_text(2. * half) + " where draft and fillet take " + as_text(2. * value_of(in)),
            "a part of the floor must remain in the arms");
    require(corner > value_of(out),
            where + "/corner radius",
            "is " + as_text(corner) + " where the rounded edge takes " + as_text(value_of(out)),
            "the corner in plan must be rounder than the edge");
    // The corner's arc is tangent to the hub's circle and to the arm's side.
    const Number reach = shape.hub + shape.corner, rise = b + shape.corner;
    require(value_of(rise) < value_of(reach),
            where + "/hub radius",
            "is " + as_text(hub) + " where the arms are " + as_text(2. * half) + " wide",
            "the hub must be wider than an arm");
    const Number foot = sqrt(Number(reach * reach - rise * rise)), angle = atan2(rise, foot);
    require(value_of(angle) < pi / 3.,
            where + "/corner radius",
            "is " + as_text(corner),
            "corners of neighbouring arms must leave a part of the hub between them");
    require(value_of(shape.length) - half > value_of(foot),
            where + "/arm length",
            "is " + as_text(value_of(shape.length)),
            "an arm must be longer than hub and corner");
    require(value_of(shape.outer) > value_of(Number(shape.length + out)),
            where + "/outer radius",
            "is " + as_text(value_of(shape.outer)),
            "the face must surround the cavity");
    const unsigned int n_cap = segments(value_of(Number(b + out)), 0.5 * pi, error),
                       n_corner =
                         segments(value_of(Number(shape.corner + in)), pi / 2. - value_of(angle), error),
                       n_hub = segments(value_of(Number(shape.hub + out)), pi / 3. - value_of(angle), error);
    const Outline<Number> outline = [&](const Number &o) {
      const Number    zero(0.), right(0.5 * pi);
      Points2<Number> points;
      append_arc(points, {Number(shape.length - b), zero}, Number(b - o), zero, right, n_cap);
      points.push_back({foot, Number(b - o)});
      append_arc(
        points, {foot, rise}, Number(shape.corner + o), Number(-0.5 * pi), Number(angle - pi), n_corner);
      append_arc(points, {zero, zero}, Number(shape.hub - o), angle, Number(pi / 3.), n_hub);
      return points;
    };
    return make_rings(where, outline, section, std::optional<Number>(shape.outer), 6);
  }

  template <typename Number>
  ShapeMesh<Number> shape_mesh(const std::string       &where,
                               const BellShape<Number> &shape,
                               const double             chord_error,
                               Segments                &segments)
  {
    const double error   = 0.5 * chord_error; // chords in plan and in section add up
    const auto   section = make_section(where, shape.profile, error, segments);
    require(value_of(shape.mouth) > value_of(section.reach_in),
            where + "/mouth radius",
            "is " + as_text(value_of(shape.mouth)) + " where draft and fillet take " +
              as_text(value_of(section.reach_in)),
            "a part of the floor must remain");
    require(value_of(shape.outer) > value_of(Number(shape.mouth + section.reach_out)),
            where + "/outer radius",
            "is " + as_text(value_of(shape.outer)),
            "the face must surround the cavity");
    const unsigned int    n = segments(value_of(Number(shape.mouth + section.reach_out)), 0.5 * pi, error);
    const Outline<Number> outline = [&](const Number &o) {
      const Number    zero(0.);
      Points2<Number> points;
      append_arc(points, {zero, zero}, Number(shape.mouth - o), zero, Number(0.5 * pi), n);
      return points;
    };
    return make_rings(where, outline, section, std::optional<Number>(shape.outer), 4);
  }

  template <typename Number>
  ShapeMesh<Number> shape_mesh(const std::string        &where,
                               const PunchShape<Number> &shape,
                               const double              chord_error,
                               Segments                 &segments)
  {
    using std::cos;
    using std::sin;
    using std::tan;
    const double error = 0.5 * chord_error; // chords in plan and in section add up
    require_positive(where, "length", shape.length);
    require_positive(where, "edge radius", shape.edge);
    require_draft(where, shape.draft);
    const Number    turn = 0.5 * pi - shape.draft * (pi / 180.), tangent = tan(Number(0.5 * turn));
    Section<Number> section;
    section.reach_in = shape.edge * tangent;
    require(value_of(shape.radius) > value_of(section.reach_in),
            where + "/radius",
            "is " + as_text(value_of(shape.radius)) + " where the rounded edge takes " +
              as_text(value_of(section.reach_in)),
            "a part of the flat end must remain");
    require(value_of(shape.length) > value_of(Number(shape.edge * (1. - cos(turn)))),
            where + "/length",
            "is " + as_text(value_of(shape.length)),
            "a punch must be longer than its edge is round");
    const unsigned int n_edge = segments(value_of(shape.edge), value_of(turn), error);
    for (unsigned int i = 0; i <= n_edge; ++i)
    {
      const Number a = turn * (double(i) / n_edge);
      section.points.push_back({section.reach_in - shape.edge * sin(a), -shape.edge * (1. - cos(a))});
    }
    const Number side = shape.length / tan(turn); // how much wider it is at the end of its side
    section.points.push_back({-side, -shape.length});
    const unsigned int    n       = segments(value_of(Number(shape.radius + side)), 0.5 * pi, error);
    const Outline<Number> outline = [&](const Number &o) {
      Points2<Number> points;
      append_arc(points, {Number(0.), Number(0.)}, Number(shape.radius - o), Number(0.), Number(0.5 * pi), n);
      return points;
    };
    return make_rings(where, outline, section, std::optional<Number>(), 4);
  }

#define RETROFORGE_INSTANTIATE(Number)                                                                       \
  template ShapeMesh<Number> shape_mesh(                                                                     \
    const std::string &, const TripodShape<Number> &, double, Segments &);                                   \
  template ShapeMesh<Number> shape_mesh(const std::string &, const BellShape<Number> &, double, Segments &); \
  template ShapeMesh<Number> shape_mesh(const std::string &, const PunchShape<Number> &, double, Segments &);
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
