// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/material/heat_law.h>

#include <deal.II/base/parameter_handler.h>

namespace retroforge
{
  /// The section Heat.
  struct HeatParameters
  {
    Heating      heating        = Heating::none;
    double       capacity       = 5.;
    double       fraction       = 0.9;
    double       conductivity   = 28.;
    double       contact_film   = 10.;
    double       dwell_film     = 2.;
    double       air_film       = 0.01;
    double       emissivity     = 0.8;
    double       surroundings   = 20.;
    double       die_effusivity = 10.;
    double       friction_part  = 0.5;
    double       transfer       = 0.;
    double       dwell          = 0.;
    double       gap            = 0.1;
    std::string  resting_die;
    unsigned int waiting_steps = 20;

    void add_parameters(dealii::ParameterHandler &prm);

    /// Returns the law of these numbers.
    HeatLaw<double> law() const;

    /// Returns what comes before the first stroke.
    /// @param resting  number of the die on which the workpiece waits
    Waiting<double> waiting(unsigned int resting) const { return {transfer, dwell, resting}; }
  };
} // namespace retroforge
