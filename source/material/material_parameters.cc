// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/material/material_parameters.h>

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
    prm.add_parameter(
      "regularising strain rate",
      law.e0,
      "e0 in e^2 -> e^2 + e0^2: keeps the viscosity finite where the metal is still. Part of the "
      "model. Zero only for m = 1. Units: 1/s.",
      Double(0.));
    prm.leave_subsection();
  }

  void MaterialParameters::check() const
  {
    if (!law.is_linear() && law.e0 == 0.)
      throw Error("Material/regularising strain rate",
                  "is 0 with a strain rate sensitivity below 1",
                  "the viscosity of still metal would be infinite",
                  "use about 1e-3 of the mean strain rate");
  }
} // namespace retroforge
