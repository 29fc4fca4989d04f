// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/enum_setting.h>
#include <retroforge/core/setting_tags.h>
#include <retroforge/material/heat_parameters.h>

namespace retroforge
{
  void HeatParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Double;
    prm.enter_subsection("Heat");
    add_enum<Heating>(
      prm,
      "heating",
      heating,
      {{"none", Heating::none}, {"adiabatic", Heating::adiabatic}},
      "none: the metal keeps the temperature before the stroke. adiabatic: the work of deformation warms it, "
      "and no "
      "heat flows, as in a fast blow: Material/temperature is that before the stroke. Units: none.");
    prm.add_parameter("heat capacity",
                      capacity,
                      "Density times specific heat, rho c: of hot steel about 5. Units: MPa/K.",
                      Double(1e-300));
    prm.add_parameter("fraction of work",
                      fraction,
                      "chi, the part of the work of deformation that becomes heat: 0.9 to 0.95. Units: none.",
                      Double(0., 1.));
    prm.leave_subsection();
    tag(prm, "Heat", SettingRole::scene);
  }
} // namespace retroforge
