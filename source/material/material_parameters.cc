// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/setting_tags.h>
#include <retroforge/material/material_parameters.h>

#include <algorithm>

namespace retroforge
{
  void MaterialParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Double;
    prm.enter_subsection("Material");
    prm.add_parameter("consistency",
                      law.K,
                      "K of the Norton-Hoff law s = 2K (sqrt3 e)^(m-1) eps. Units: MPa s^m.",
                      Double(1e-300));
    prm.add_parameter(
      "strain rate sensitivity",
      law.m,
      "m of the Norton-Hoff law: 1 is a Newtonian fluid, hot steel is near 0.14. Units: none.",
      Double(1e-3, 1.));
    prm.add_parameter("regularising strain rate",
                      law.e0,
                      "e0 in e^2 -> e^2 + e0^2: keeps the viscosity finite where the metal is still. Part of "
                      "the model. 0 takes "
                      "1e-3 or, where the scene is slow, a hundredth of the speed at which the dies close "
                      "over the height of the "
                      "billet. Units: 1/s.",
                      Double(0.));
    prm.leave_subsection();
    tag(prm, "Material", SettingRole::scene);
  }

  MaterialLaw<double> MaterialParameters::law_at(const double rate) const
  {
    MaterialLaw<double> complete = law;
    if (law.e0 == 0.)
      complete.e0 = std::min(1e-3, 1e-2 * rate);
    return complete;
  }
} // namespace retroforge
