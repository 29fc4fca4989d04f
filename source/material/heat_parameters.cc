// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/enum_setting.h>
#include <retroforge/core/setting_tags.h>
#include <retroforge/material/heat_parameters.h>
#include <retroforge/material/temperature_range.h>

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
      {{"none", Heating::none}, {"adiabatic", Heating::adiabatic}, {"conduction", Heating::conduction}},
      "none: the metal keeps the temperature before the stroke. adiabatic: the work of deformation warms it, "
      "and no heat flows, as in a fast blow. conduction: it flows, to dies and surroundings, too; settings "
      "from "
      "`conductivity' on are read. Material/temperature is that before it all. Units: none.");
    prm.add_parameter("heat capacity",
                      capacity,
                      "Density times specific heat, rho c: of hot steel about 5. Units: MPa/K.",
                      Double(1e-300));
    prm.add_parameter("fraction of work",
                      fraction,
                      "chi, the part of the work of deformation that becomes heat: 0.9 to 0.95. Units: none.",
                      Double(0., 1.));
    prm.add_parameter("conductivity",
                      conductivity,
                      "k, of hot steel about 28. Units: mW/(mm K), which is W/(m K).",
                      Double(1e-300));
    prm.add_parameter(
      "contact film",
      contact_film,
      "Conductance of contact between metal and dies while metal flows: 10 to 20, less with thick scale. "
      "Units: mW/(mm^2 K), which is kW/(m^2 K).",
      Double(0.));
    prm.add_parameter(
      "dwell film",
      dwell_film,
      "The same while the workpiece waits on a die under its weight: 1 to 2. Units: mW/(mm^2 K).",
      Double(0.));
    prm.add_parameter(
      "contact gap", gap, "Between metal and die, across which contact fades. Units: mm.", Double(1e-300));
    prm.add_parameter(
      "air film", air_film, "Of the free surface, without radiation. Units: mW/(mm^2 K).", Double(0.));
    prm.add_parameter("emissivity",
                      emissivity,
                      "Of the free surface, which radiates to the surroundings; 0 for none. Units: none.",
                      Double(0., 1.));
    prm.add_parameter("surroundings",
                      surroundings,
                      "Temperature of air and walls around the workpiece. Units: C.",
                      Double(absolute_zero));
    prm.add_parameter(
      "die effusivity",
      die_effusivity,
      "sqrt(k rho c) of the dies, whose surface warms by what they take: of tool steel about 10. "
      "Units: mW s^(1/2)/(mm^2 K).",
      Double(1e-300));
    prm.add_parameter(
      "friction part",
      friction_part,
      "Part of friction's heat that goes into the metal, on its side of the film. The rest goes into the "
      "dies. Units: none.",
      Double(0., 1.));
    prm.add_parameter("transfer time",
                      transfer,
                      "Time that the workpiece is in the surroundings before it is on the dies. Units: s.",
                      Double(0.));
    prm.add_parameter("dwell time",
                      dwell,
                      "Time that it then waits on `resting die' before the stroke. Units: s.",
                      Double(0.));
    prm.add_parameter(
      "resting die",
      resting_die,
      "Die on which it waits; empty: the first that stands still, or the first. Units: none.");
    prm.add_parameter("waiting steps",
                      waiting_steps,
                      "Steps of time of transfer, and of dwell, short ones first. Units: none.",
                      dealii::Patterns::Integer(1));
    prm.leave_subsection();
    tag(prm, "Heat", SettingRole::scene);
  }

  HeatLaw<double> HeatParameters::law() const
  {
    HeatLaw<double> law;
    law.capacity       = capacity;
    law.fraction       = fraction;
    law.conductivity   = conductivity;
    law.contact_film   = contact_film;
    law.dwell_film     = dwell_film;
    law.air_film       = air_film;
    law.emissivity     = emissivity;
    law.surroundings   = surroundings;
    law.die_effusivity = die_effusivity;
    law.friction_part  = friction_part;
    law.gap            = gap;
    law.heating        = static_cast<unsigned int>(heating);
    law.waiting_steps  = waiting_steps;
    return law;
  }
} // namespace retroforge
