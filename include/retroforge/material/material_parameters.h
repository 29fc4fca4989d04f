// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/material/material_law.h>

#include <deal.II/base/parameter_handler.h>

namespace retroforge
{
  struct MaterialParameters
  {
    MaterialLaw<double> law{1.693, 0.139, 1e-3};

    void add_parameters(dealii::ParameterHandler &prm);
    void check() const;
  };
} // namespace retroforge
