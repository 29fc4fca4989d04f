// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/numbers.h>

namespace retroforge
{
  /// What becomes of the heat.
  enum class Heating : unsigned int
  {
    none,     ///< the temperature is that before the stroke
    adiabatic ///< work of deformation warms the metal, which keeps it
  };

  /// The numbers of the metal's heat.
  template <typename Number>
  struct HeatLaw
  {
    Number       capacity = Number(0.); ///< rho c [MPa/K]
    Number       fraction = Number(0.); ///< chi, the part of the work of deformation that becomes heat
    unsigned int heating  = 0;          ///< a Heating

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[capacity, fraction, heating] = self;
      return std::tie(capacity, fraction, heating);
    }

    static std::vector<NumberInfo> info()
    {
      return {{"heat capacity", "MPa/K"}, {"fraction of work", "", true, 1.}};
    }

    /// Tells whether the workpiece has a temperature at each node.
    bool warms() const { return heating != static_cast<unsigned int>(Heating::none); }
  };
} // namespace retroforge
