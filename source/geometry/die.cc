// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/geometry/die.h>

namespace retroforge
{
  void DieParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection("Die " + name);
    prm.add_parameter("point", point, "A point of the working face at the start of the run. Units: mm.");
    prm.add_parameter(
      "facing",
      facing,
      "Normal of the working face, pointing from the die to the workpiece; of any length. Units: none.");
    prm.add_parameter("velocity", velocity, "Velocity of the die, constant. Units: mm/s.");
    prm.add_parameter(
      "friction",
      friction,
      "alpha of the Norton friction law tau = -alpha K |dv|^(m-1) dv; 0 is a frictionless die. "
      "Units: mm^(-m).",
      dealii::Patterns::Double(0.));
    prm.leave_subsection();
  }

  void DieParameters::check()
  {
    if (!(facing.norm() > 0.))
      throw Error("Die " + name + "/facing",
                  "is the zero vector",
                  "it must point from the die to the workpiece",
                  "use for instance 0, 0, 1 for a lower die");
    facing /= facing.norm();
  }
} // namespace retroforge
