// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/case/check_parameters.h>
#include <retroforge/core/setting_tags.h>

namespace retroforge
{
  void CheckParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    prm.enter_subsection("Check");
    prm.add_parameter(
      "steps",
      steps,
      "Steps of the finite differences, relative to the parameter's value or the billet's size. "
      "Units: none.",
      List(Double(1e-12, 1.), 1));
    prm.add_parameter(
      "free differences",
      free,
      "Also run with everything decided anew, contact and meshes and all, but for the increments "
      "(Design/repeat steps): shows the jumps that decisions make. Units: none.");
    prm.add_parameter("taylor start",
                      taylor_start,
                      "Largest relative step of the Taylor test. Units: none.",
                      Double(1e-12, 1.));
    prm.add_parameter("taylor halvings", taylor_halvings, "Units: none.", Integer(2));
    prm.add_parameter(
      "replayed bar",
      replayed_bar,
      "Relative error that the best replayed central difference, or what two neighbouring steps "
      "extrapolate to, must reach: the forces of "
      "contact, penalties times "
      "small differences of speeds, are known to some 1e-10. Units: none.",
      Double(0.));
    prm.add_parameter(
      "tangent bar",
      tangent_bar,
      "Relative difference allowed between adjoint and direct method, for the same reason. Units: none.",
      Double(0.));
    prm.add_parameter(
      "taylor bar", taylor_bar, "Least order of the Taylor remainder. Units: none.", Double(0.));
    prm.leave_subsection();
    tag(prm, "Check", SettingRole::check);
  }

  unsigned int CheckParameters::n_runs() const
  {
    return (free ? 4 : 2) * steps.size() + taylor_halvings + 1;
  }
} // namespace retroforge
