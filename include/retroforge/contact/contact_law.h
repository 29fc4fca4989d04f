// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/material/material_law.h>

namespace retroforge
{
  /// The numbers of the contact and friction laws.
  template <typename Number>
  struct ContactLaw
  {
    Number rho = Number(0.); ///< penalty [MPa s/mm]
    Number v0  = Number(0.); ///< slip regularisation [mm/s]

    ContactLaw() = default;
    ContactLaw(const Number &rho, const Number &v0) : rho(rho), v0(v0) {}

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[rho, v0] = self;
      return std::tie(rho, v0);
    }

    static std::vector<NumberInfo> info() { return {{"rho", "MPa s/mm"}, {"v0", "mm/s", true}}; }

    /// Returns whether contact depends on the number with a name of info().
    static bool depends_on(const std::string &name, const bool with_friction)
    {
      return name != "v0" || with_friction;
    }
  };
} // namespace retroforge
