// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/die.h>

#include <deal.II/base/parameter_handler.h>

#include <string>

namespace retroforge
{
  /// The settings of a zone of a die, in which friction is another than the die's own: the section `Zone NAME` in
  /// that of the die.
  struct DieZoneParameters
  {
    std::string name, die_section;
    Vec3        from, to; ///< corners of a box, where the die stands at the start [mm]
    std::string friction_law = "Norton";
    double      friction     = 0.;
    double      shear_limit  = 1.;

    DieZoneParameters(std::string name, std::string die_section)
        : name(std::move(name)), die_section(std::move(die_section))
    {
    }

    std::string section() const { return die_section + "/Zone " + name; }

    /// Declares the settings, in the section of the die.
    void add_parameters(dealii::ParameterHandler &prm);
    void check() const;
  };

  /// Declares the settings `friction law`, `friction` and `shear limit`, of a die or a zone.
  void add_friction(dealii::ParameterHandler &prm, std::string &law, double &friction, double &shear_limit);

  /// @throws Error  where two zones overlap: which friction holds there would be open
  void check_apart(const std::vector<DieZoneParameters> &zones);

  /// Returns the boxes of the zones.
  /// @throws Error  for one that no part of the die is in, so that its friction would act nowhere
  FrictionZones zones_of(const Die &die, const std::vector<DieZoneParameters> &zones, double edge);
} // namespace retroforge
