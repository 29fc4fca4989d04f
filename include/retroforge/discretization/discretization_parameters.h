// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/discretization/discretization.h>

#include <deal.II/base/parameter_handler.h>

namespace retroforge
{
  /// The section Discretization.
  struct DiscretizationParameters
  {
    DiscretizationChoice choice;

    void add_parameters(dealii::ParameterHandler &prm);

    /// @throws Error  if what is chosen does not go together
    void check() const { check_choice<3>(choice); }
  };
} // namespace retroforge
