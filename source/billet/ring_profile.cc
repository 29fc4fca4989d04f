// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/patterns.h>

#include <retroforge/billet/ring_profile.h>

#include <cmath>
#include <sstream>

namespace retroforge
{
  void RingProfile::add_parameters(dealii::ParameterHandler &prm)
  {
    const dealii::Patterns::Double length(0.);
    prm.add_parameter("mu1", mu[0], "Height of the ring: of its flat top above the base. Units: mm.", length);
    prm.add_parameter("mu2", mu[1], "Outer radius of the ring's flat top. Units: mm.", length);
    prm.add_parameter(
      "mu3", mu[2], "Height above the base at which the ring's upper outer edge begins. Units: mm.", length);
    prm.add_parameter("mu4", mu[3], "Outer radius of the ring. Units: mm.", length);
    prm.add_parameter("bore radius", bore_radius, "Radius of the ring's bore. Units: mm.", length);
    prm.add_parameter("base inner radius",
                      base_inner_radius,
                      "Radius at which the ring's flat base begins. Units: mm.",
                      length);
    prm.add_parameter("base outer radius",
                      base_outer_radius,
                      "Radius at which the ring's flat base ends. Units: mm.",
                      length);
    prm.add_parameter("inner edge height",
                      inner_edge_height,
                      "Height of the ring's lower inner edge, a quarter of an ellipse. Units: mm.",
                      length);
    prm.add_parameter("outer edge height",
                      outer_edge_height,
                      "Height of the ring's lower outer edge, a parabola. Units: mm.",
                      length);
  }

  std::string RingProfile::complaint(const std::array<double, 4> &mu) const
  {
    struct Measure
    {
      const char *name;
      double      value;
    };
    const Measure mu1 = {"mu1", mu[0]}, mu2 = {"mu2", mu[1]}, mu3 = {"mu3", mu[2]}, mu4 = {"mu4", mu[3]};
    const Measure zero = {"zero", 0.}, bore = {"bore radius", bore_radius},
                  inner                           = {"base inner radius", base_inner_radius},
                  outer                           = {"base outer radius", base_outer_radius},
                  left                            = {"inner edge height", inner_edge_height},
                  right                           = {"outer edge height", outer_edge_height};
    const std::pair<Measure, Measure> ascending[] = {{zero, bore},
                                                     {bore, inner},
                                                     {inner, outer},
                                                     {outer, mu4},
                                                     {inner, mu2},
                                                     {mu2, mu4},
                                                     {zero, left},
                                                     {zero, right},
                                                     {left, mu3},
                                                     {right, mu3},
                                                     {mu3, mu1}};
    for (const auto &[less, more] : ascending)
      if (!(less.value < more.value) || !std::isfinite(more.value))
      {
        std::ostringstream text;
        text << more.name << " = " << more.value << " is not above " << less.name;
        if (less.value != 0.)
          text << " = " << less.value;
        return text.str();
      }
    return "";
  }

  Section RingProfile::section() const
  {
    const Vec2 p1({bore_radius, inner_edge_height}), p2({bore_radius, mu[0]}), p3({mu[1], mu[0]}),
      p4({mu[3], mu[2]}), p5({mu[3], outer_edge_height}), p6({base_outer_radius, 0.}),
      p7({base_inner_radius, 0.});
    // A parabola is the quadratic spline of its ends and of where their tangents meet; a quarter of an
    // ellipse likewise, with the middle weight cos(45 degrees).
    const Vec2 upper({p4[0], (p3[1] + p4[1]) / 2.});
    const Vec2 lower({(p5[0] + p6[0]) / 2., p6[1]});
    return {{"side inner", segment(p1, p2)},
            {"top", segment(p2, p3)},
            {"edge top outer", {{p3, upper, p4}, 2}},
            {"side outer", segment(p4, p5)},
            {"edge bottom outer", {{p5, lower, p6}, 2}},
            {"bottom", segment(p6, p7)},
            {"edge bottom inner", {{p7, Vec2({p1[0], p7[1]}), p1}, 2, {1., std::sqrt(0.5), 1.}}}};
  }
} // namespace retroforge
