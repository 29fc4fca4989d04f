// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/steps/scheme.h>

#include <deal.II/base/parameter_handler.h>

#include <string>

namespace retroforge
{
  struct PressParameters
  {
    std::string  leading_die;
    double       stroke          = 10.;
    unsigned int increments      = 0;
    std::string  scheme          = Scheme::all().front().name;
    double       smallest_volume = 0.2;
    double       largest_move    = 0.5;
    double       largest_slip    = 1.;
    unsigned int max_cuts        = 8;
    double       largest_loss    = 0.02;

    void add_parameters(dealii::ParameterHandler &prm);
  };
} // namespace retroforge
