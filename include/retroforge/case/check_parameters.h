// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/parameter_handler.h>

#include <vector>

namespace retroforge
{
  struct CheckParameters
  {
    std::vector<double> steps           = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7};
    bool                free            = true;
    double              taylor_start    = 3e-4;
    unsigned int        taylor_halvings = 4;
    double              replayed_bar    = 3e-6;
    double              tangent_bar     = 1e-9;
    double              taylor_bar      = 1.95;

    /// Forgings along each direction that is checked, beside the tangent.
    unsigned int n_runs() const;

    void add_parameters(dealii::ParameterHandler &prm);
  };
} // namespace retroforge
