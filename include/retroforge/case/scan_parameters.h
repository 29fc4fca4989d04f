// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

namespace retroforge
{
  struct ScanParameters
  {
    std::string  parameter;
    double       range     = 0.01;
    unsigned int points    = 17;
    unsigned int degree    = 3;
    bool         gradients = true;
    unsigned int processes = 0;

    void add_parameters(dealii::ParameterHandler &prm);
    /// @throws Error
    void check() const;

    /// Equally spaced, and exactly `nominal` in the middle of an odd number.
    /// @param scale  what `range` is relative to where the nominal value is zero
    std::vector<double> values(double nominal, double scale) const;
  };
} // namespace retroforge
