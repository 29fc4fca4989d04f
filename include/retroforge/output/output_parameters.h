// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/parameter_handler.h>

#include <optional>

namespace retroforge
{
  /// The section Output.
  struct OutputParameters
  {
    std::optional<unsigned int>
         every; ///< increments between pictures; unset: pictures evenly over the stroke
    bool record = true;

    void add_parameters(dealii::ParameterHandler &prm);
  };
} // namespace retroforge
