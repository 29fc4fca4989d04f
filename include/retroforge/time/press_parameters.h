// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/steps/press_motion.h>
#include <retroforge/steps/scheme.h>
#include <retroforge/time/given_steps.h>

#include <deal.II/base/parameter_handler.h>

#include <optional>
#include <string>

namespace retroforge
{
  struct PressParameters
  {
    std::string         leading_die;
    std::string         motion_type = "constant speed";
    std::vector<double> motion_numbers; ///< of this type
    double              stroke     = 10.;
    unsigned int        increments = 0;
    double              accuracy   = 1e-3;
    /// What the program chooses where `increments` is 0: the largest mean strain of an increment, and how many
    /// there may be.
    std::optional<double> largest_strain;
    unsigned int          most_increments = 0;
    std::string           steps_file;
    GivenSteps            steps; ///< those of the file, or of another design
    std::string           scheme          = Scheme::all().front().name;
    double                smallest_volume = 0.2;
    double                largest_move    = 0.5;
    double                largest_slip    = 1.;
    unsigned int          max_cuts        = 8;
    double                largest_loss    = 0.02;

    void add_parameters(dealii::ParameterHandler &prm);

    /// Returns the motion of the press.
    /// @throws Error  where there is no such motion, or its numbers are not what it has
    PressMotion<double> motion() const;
  };
} // namespace retroforge
