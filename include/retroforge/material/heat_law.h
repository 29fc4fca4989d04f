// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/numbers.h>

namespace retroforge
{
  /// What becomes of the heat.
  enum class Heating : unsigned int
  {
    none,      ///< the temperature is that before the stroke
    adiabatic, ///< work of deformation warms the metal, which keeps it
    conduction ///< heat flows in the metal, to the dies, and to the surroundings
  };

  /// The numbers of the metal's heat and of what it touches. Those after the first two are read where it flows.
  template <typename Number>
  struct HeatLaw
  {
    Number capacity       = Number(0.); ///< rho c [MPa/K]
    Number fraction       = Number(0.); ///< chi, the part of the work of deformation that becomes heat
    Number conductivity   = Number(0.); ///< k [mW/(mm K)]
    Number contact_film   = Number(0.); ///< h_c between metal and dies that touch [mW/(mm^2 K)]
    Number dwell_film     = Number(0.); ///< the same while the workpiece waits [mW/(mm^2 K)]
    Number air_film       = Number(0.); ///< of the free surface [mW/(mm^2 K)]
    Number emissivity     = Number(0.); ///< of the free surface
    Number surroundings   = Number(0.); ///< temperature [C]
    Number die_effusivity = Number(0.); ///< sqrt(k rho c) of the dies [mW s^(1/2)/(mm^2 K)]
    Number friction_part  = Number(0.); ///< part of friction's heat that goes into the metal
    Number transfer       = Number(0.); ///< time in the surroundings before the first stroke [s]
    Number dwell          = Number(0.); ///< time on the resting die after that [s]
    Number gap            = Number(0.); ///< between metal and die across which contact fades, frozen [mm]

    unsigned int heating       = 0; ///< a Heating
    unsigned int resting_die   = 0; ///< on which the workpiece waits
    unsigned int waiting_steps = 0; ///< steps in time of transfer and of dwell

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[capacity,
             fraction,
             conductivity,
             contact_film,
             dwell_film,
             air_film,
             emissivity,
             surroundings,
             die_effusivity,
             friction_part,
             transfer,
             dwell,
             gap,
             heating,
             resting_die,
             waiting_steps] = self;
      return std::tie(capacity,
                      fraction,
                      conductivity,
                      contact_film,
                      dwell_film,
                      air_film,
                      emissivity,
                      surroundings,
                      die_effusivity,
                      friction_part,
                      transfer,
                      dwell,
                      gap,
                      heating,
                      resting_die,
                      waiting_steps);
    }

    static std::vector<NumberInfo> info()
    {
      return {{"heat capacity", "MPa/K"},
              {"fraction of work", "", true, 1.},
              {"conductivity", "mW/(mm K)"},
              {"contact film", "mW/(mm^2 K)", true},
              {"dwell film", "mW/(mm^2 K)", true},
              {"air film", "mW/(mm^2 K)", true},
              {"emissivity", "", true, 1.},
              {"surroundings", "C", true, std::numeric_limits<double>::infinity(), {}, true},
              {"die effusivity", "mW s^(1/2)/(mm^2 K)"},
              {"friction part", "", true, 1.},
              {"transfer time", "s", true},
              {"dwell time", "s", true}};
    }

    /// Tells whether anything depends on a number of info().
    bool reads(const std::string &name) const
    {
      if (name == "heat capacity" || name == "fraction of work")
        return warms();
      if (name == "transfer time")
        return conducts() && value_of(transfer) > 0.;
      if (name == "dwell time" || name == "dwell film")
        return conducts() && value_of(dwell) > 0.;
      return conducts();
    }

    /// Tells whether the workpiece has a temperature at each node.
    bool warms() const { return heating != static_cast<unsigned int>(Heating::none); }

    /// Tells whether heat flows.
    bool conducts() const { return heating == static_cast<unsigned int>(Heating::conduction); }
  };
} // namespace retroforge
