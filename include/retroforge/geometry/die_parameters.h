// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/die_kind.h>
#include <retroforge/geometry/die_zone_parameters.h>

namespace retroforge
{
  /// The settings of a die: the section `Die NAME`. A plane goes through `point`; DieKind says where dies of
  /// other shapes stand.
  struct DieParameters
  {
    std::string     name;
    Choice<DieKind> shape{die_kinds(), "plane"};
    Vec3            point;
    Vec3            facing;
    Vec3            velocity;
    std::string     friction_law   = "Norton";
    double          friction       = 0.;
    double          shear_limit    = 1.;
    double          temperature    = 200.;
    bool            follows_billet = false;

    std::vector<DieZoneParameters> zones; ///< where other friction holds
    double                         zone_edge = 1.;

    explicit DieParameters(std::string name) : name(std::move(name)) {}

    void add_parameters(dealii::ParameterHandler &prm);
    /// Normalises `facing`.
    void check();

    DiePlace place() const { return {name, section(), point, facing}; }

    /// @throws Error  for a file or measures that make no surface, or a zone where there is none
    Die die() const;

    std::string section() const { return "Die " + name; }
  };
} // namespace retroforge
