// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/number_checks.h>
#include <retroforge/core/setting_tags.h>
#include <retroforge/material/material_parameters.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  void MaterialParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Double;
    prm.enter_subsection("Material");
    prm.add_parameter("law",
                      type,
                      "Law of the metal at a point. Norton-Hoff, s = 2K (sqrt3 e)^(m-1) eps, is the same "
                      "everywhere; programs that use the library may add others. Units: none.");
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
    prm.add_parameter("further numbers",
                      numbers,
                      "Numbers that the law has beyond these, in its order; Norton-Hoff has none. Units: "
                      "those of the law.");
    prm.leave_subsection();
    tag(prm, "Material", SettingRole::scene);
  }

  Material<double> MaterialParameters::metal(const double rate) const
  {
    Material<double> metal(law);
    metal.type    = find_material_type(type, "Material/law");
    metal.numbers = numbers;
    check_numbers(
      metal.numbers, material_type(metal.type).info(), "Material/further numbers", "the law '" + type + "'");
    if (law.e0 == 0.)
      metal.law.e0 = std::min(1e-3, 1e-2 * rate);
    return metal;
  }
} // namespace retroforge
