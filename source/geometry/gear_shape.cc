// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/geometry/die_rings.templates.h>

namespace retroforge
{
  using namespace die_rings;

  namespace
  {
    /// Half a tooth and half a gap in plan, moved inwards by o: the circles of tip and root, and a flank, the
    /// line n·x = c, metal where n·x is more; d runs along it outwards.
    template <typename Number>
    struct GearOutline
    {
      Point2<Number> n, d;
      Number         tip, root, c, tip_round, root_round;

      GearOutline(const GearShape<Number> &shape, const Number &o)
          : tip(shape.tip - o), root(shape.root - o), tip_round(shape.tip_round), root_round(shape.root_round)
      {
        using std::cos;
        using std::sin;
        const Number flank = shape.flank * (pi / 180.), half = shape.tooth * (0.5 * pi / 180.);
        n = {Number(-sin(flank)), Number(-cos(flank))};
        d = {Number(cos(flank)), Number(-sin(flank))};
        c = shape.reference * (n.x * cos(half) + n.y * sin(half)) + o;
      }

      /// Returns the square of the position along the flank at which the rounding begins whose centre is
      /// `off` it and at `distance` from the axis; negative when there is none.
      Number along_squared(const Number &distance, const Number &off) const
      {
        return distance * distance - (c + off) * (c + off);
      }

      Point2<Number> centre(const Number &distance, const Number &off) const
      {
        using std::sqrt;
        const Number s = sqrt(along_squared(distance, off)), level = c + off;
        return {Number(n.x * level + d.x * s), Number(n.y * level + d.y * s)};
      }

      Number tip_distance() const { return tip - tip_round; }
      Number root_distance() const { return root + root_round; }
    };

    /// Throws where tip, flank and root do not leave a part of each other.
    template <typename Number>
    void check_outline(const std::string &where, const GearShape<Number> &shape, const Number &o)
    {
      const GearOutline<Number> plan(shape, o);
      const char               *here = value_of(o) > 0. ? " where draft and fillet end" : "";
      const double              tip  = value_of(plan.along_squared(plan.tip_distance(), plan.tip_round)),
                   root = value_of(plan.along_squared(plan.root_distance(), Number(-plan.root_round)));
      require(value_of(plan.tip_distance()) > 0. && tip > 0.,
              where + "/tip rounding",
              "is " + as_text(value_of(shape.tip_round)) + ", more than the tooth is wide" + here,
              "a part of the flank and of the tip must remain");
      require(root > 0. && root < tip,
              where + "/root rounding",
              "is " + as_text(value_of(shape.root_round)) + " and leaves nothing of the flank" + here,
              "a flank must run between the roundings of a tooth's foot and end");
      const auto angle = [](const Point2<Number> &x) { return std::atan2(value_of(x.y), value_of(x.x)); };
      require(angle(plan.centre(plan.tip_distance(), plan.tip_round)) > 0.,
              where + "/tip radius",
              "is " + as_text(value_of(shape.tip)) + ", where the flanks have met" + here,
              "a part of the tooth's end must remain: take a wider tooth, steeper flanks or less rounding");
      require(angle(plan.centre(plan.root_distance(), Number(-plan.root_round))) < pi / shape.teeth,
              where + "/root radius",
              "is " + as_text(value_of(shape.root)) + ", where the roundings of neighbouring teeth meet" +
                here,
              "a part of the root must remain: take fewer or narrower teeth or less rounding");
    }
  } // namespace

  template <typename Number>
  ShapeMesh<Number> shape_mesh(const std::string       &where,
                               const GearShape<Number> &shape,
                               const double             chord_error,
                               Segments                &segments)
  {
    using std::atan2;
    const double error   = 0.5 * chord_error; // chords in plan and in section add up
    const auto   section = make_section(where, shape.profile, error, segments);
    require(
      shape.teeth >= 3, where + "/teeth", "is " + as_text(shape.teeth), "a gear has at least three teeth");
    require_positive(where, "root rounding", shape.root_round);
    require_positive(where, "tip rounding", shape.tip_round);
    const Number in = section.reach_in, out = section.reach_out;
    const double root = value_of(shape.root), reference = value_of(shape.reference),
                 tip = value_of(shape.tip);
    require(
      value_of(in) < root && root < reference && reference < tip,
      where + "/reference radius",
      "is " + as_text(reference),
      "it must lie between the radii of root and tip, and the root must be wider than draft and fillet");
    require(value_of(shape.outer) > tip + value_of(out),
            where + "/outer radius",
            "is " + as_text(value_of(shape.outer)),
            "the face must surround the cavity");
    for (const Number &o : {Number(-out), Number(0.), in})
      check_outline(where, shape, o);
    const double       pitch = pi / shape.teeth, quarter = 0.5 * pi - value_of(shape.flank) * pi / 180.;
    const unsigned int n_tip      = segments(tip + value_of(out), pitch, error),
                       n_end      = segments(value_of(shape.tip_round), quarter, error),
                       n_foot     = segments(value_of(shape.root_round), quarter, error),
                       n_root     = segments(root + value_of(out), pitch, error);
    const Outline<Number> outline = [&](const Number &o) {
      const GearOutline<Number> plan(shape, o);
      const Number              slope = shape.flank * (pi / 180.), zero(0.);
      const Point2<Number>      axis = {zero, zero}, end = plan.centre(plan.tip_distance(), plan.tip_round),
                           foot = plan.centre(plan.root_distance(), Number(-plan.root_round));
      const Number    end_angle = atan2(end.y, end.x), foot_angle = atan2(foot.y, foot.x);
      Points2<Number> points;
      append_arc(points, axis, plan.tip, zero, end_angle, n_tip);
      append_arc(points, end, plan.tip_round, end_angle, Number(0.5 * pi - slope), n_end);
      points.push_back({foot.x + plan.root_round * plan.n.x, foot.y + plan.root_round * plan.n.y});
      append_arc(points, foot, plan.root_round, Number(-0.5 * pi - slope), Number(foot_angle - pi), n_foot);
      append_arc(points, axis, plan.root, foot_angle, Number(pitch), n_root);
      return points;
    };
    return make_rings(where, outline, section, std::optional<Number>(shape.outer), 2 * shape.teeth);
  }

  template ShapeMesh<double> shape_mesh(const std::string &, const GearShape<double> &, double, Segments &);
  template ShapeMesh<Dual>   shape_mesh(const std::string &, const GearShape<Dual> &, double, Segments &);
} // namespace retroforge
