// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/case/parameters.h>

namespace retroforge
{
  /// Metal that hardens as (q + q0)^n and softens as it warms.
  inline void harden_by_power(Parameters &p)
  {
    p.material.type        = "power";
    p.material.numbers     = {{"n", 0.4}, {"q0", 0.1}, {"beta", 0.002}, {"m1", 1e-4}, {"T0", 900.}};
    p.material.temperature = "1000";
  }

  /// The metal warms by its work, by some ten degrees, and softens by that.
  inline Parameters warming(Parameters p)
  {
    harden_by_power(p);
    p.heat.heating  = Heating::adiabatic;
    p.heat.capacity = 0.05;
    return p;
  }

  /// Heat flows, too: some ten degrees are lost to dies and air before the stroke and in it.
  inline Parameters conducting(Parameters p)
  {
    p                     = warming(p);
    p.heat.heating        = Heating::conduction;
    p.heat.conductivity   = 1.;
    p.heat.contact_film   = 0.3;
    p.heat.dwell_film     = 0.1;
    p.heat.air_film       = 0.02;
    p.heat.die_effusivity = 0.5;
    p.heat.transfer       = 0.3;
    p.heat.dwell          = 0.1;
    p.heat.waiting_steps  = 3;
    p.heat.gap            = 4.;
    return p;
  }
} // namespace retroforge
