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
    Heating heating  = Heating::none;
    double  capacity = 5.;
    double  fraction = 0.9;

    void add_parameters(dealii::ParameterHandler &prm);

    /// Returns the law of these numbers.
    HeatLaw<double> law() const { return {capacity, fraction, static_cast<unsigned int>(heating)}; }
  };
} // namespace retroforge
