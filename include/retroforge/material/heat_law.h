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

  /// What the workpiece goes through before a stroke, where heat flows.
  template <typename Number>
  struct Waiting
  {
    Number       transfer    = Number(0.); ///< time in the surroundings [s]
    Number       dwell       = Number(0.); ///< time on the resting die after that [s]
    unsigned int resting_die = 0;          ///< on which it waits

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[transfer, dwell, resting_die] = self;
      return std::tie(transfer, dwell, resting_die);
    }
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
    Number gap            = Number(0.); ///< between metal and die across which contact fades, frozen [mm]

    unsigned int heating       = 0; ///< a Heating
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
             gap,
             heating,
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
                      gap,
                      heating,
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
              {"friction part", "", true, 1.}};
    }

    /// Tells whether anything depends on a number of info(); on the dwell film, if the workpiece waits on a die.
    bool reads(const std::string &name) const
    {
      if (name == "heat capacity" || name == "fraction of work")
        return warms();
      return conducts();
    }

    /// Tells whether the workpiece has a temperature at each node.
    bool warms() const { return heating != static_cast<unsigned int>(Heating::none); }

    /// Tells whether heat flows.
    bool conducts() const { return heating == static_cast<unsigned int>(Heating::conduction); }
  };
} // namespace retroforge
