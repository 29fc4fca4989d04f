// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/parameter_handler.h>

#include <map>
#include <string>
#include <vector>

namespace retroforge
{
  /// The section Design.
  struct DesignParameters
  {
    std::vector<std::string>           names = {"material/K"};
    std::multimap<std::string, double> at;
    /// Values of the billet's parameters at which it is meshed anew, one set after the other.
    std::vector<std::multimap<std::string, double>> meshed_at;
    bool                                            repeat_steps = true;

    void add_parameters(dealii::ParameterHandler &prm);

    /// `names`, and those of `at` that are not among them.
    std::vector<std::string> all_names() const;
  };
} // namespace retroforge
