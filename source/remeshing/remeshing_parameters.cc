// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/remeshing/remeshing_parameters.h>

#include <string>

namespace retroforge
{
  namespace
  {
    void require_order(const std::string &less_name, double less, const std::string &more_name, double more)
    {
      if (less > more)
        throw Error("Remeshing/" + less_name,
                    "is " + as_text(less),
                    "must not exceed `" + more_name + "`, which is " + as_text(more),
                    "lower the one or raise the other");
    }
  } // namespace

  void RemeshingParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Double;
    prm.enter_subsection("Remeshing");
    prm.add_parameter("trigger angle",
                      trigger_angle,
                      "The mesh is repaired when a dihedral angle is smaller. Units: degrees.",
                      Double(0., 30.));
    prm.add_parameter(
      "goal angle",
      goal_angle,
      "Nodes are moved, removed and inserted until no dihedral angle is smaller (or its sine, for "
      "obtuse ones); above 20, values diffuse much more. Units: degrees.",
      Double(0., 30.));
    prm.add_parameter(
      "swap angle",
      swap_angle,
      "Edges and faces are exchanged, without moving nodes, where a dihedral angle is smaller. "
      "Units: degrees.",
      Double(0., 60.));
    prm.add_parameter("ridge angle",
                      ridge_angle,
                      "Edges where the surface turns by more are kept, as are those between patches. "
                      "Units: degrees.",
                      Double(1., 180.));
    prm.add_parameter("corner angle",
                      corner_angle,
                      "Nodes where such an edge line turns by more are kept. Units: degrees.",
                      Double(1., 180.));
    prm.add_parameter("shortest edge",
                      shortest_edge,
                      "Edges shorter than this times the wanted length are collapsed. Units: none.",
                      Double(0., 1.));
    prm.add_parameter("longest edge",
                      longest_edge,
                      "Edges longer than this times the wanted length are split. Units: none.",
                      Double(1.));
    prm.leave_subsection();
  }

  void RemeshingParameters::check() const
  {
    require_order("trigger angle", trigger_angle, "goal angle", goal_angle);
    require_order("goal angle", goal_angle, "swap angle", swap_angle);
    // Halves of an edge just split must not be collapsed again.
    require_order("shortest edge", shortest_edge, "longest edge / 2", longest_edge / 2);
  }
} // namespace retroforge
