// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/material/material.h>

#include <deal.II/base/parameter_handler.h>

#include <map>

namespace retroforge
{
  struct MaterialParameters
  {
    std::string                   type = "Norton-Hoff";
    MaterialLaw<double>           law{1.693, 0.139, 0.};
    std::map<std::string, double> numbers;     ///< further numbers of the type, by name
    std::string                   table;       ///< file of the type `table`
    std::string                   temperature; ///< of the billet before the stroke [C]; empty: not given
    Damage                        damage = Damage::none;
    /// Where the numbers of the law hold, from and to: temperatures [C] and strain rates [1/s]; empty: not told.
    std::vector<double> valid_temperatures, valid_rates;

    void add_parameters(dealii::ParameterHandler &prm);

    /// Returns the metal, with the regularising strain rate where it is left open: 1e-3 /s or, where the
    /// metal is strained slowly, a hundredth of its rate, which changes the stress by less than 5e-5.
    /// @param rate  strain rate of the scene [1/s]
    /// @throws Error  where there is no such law, or its numbers are not what it has
    Material<double> metal(double rate) const;
  };

  /// Returns whether a value lies outside of a range, which is empty where it is not told.
  inline bool is_beyond(const std::vector<double> &range, const double value)
  {
    return !range.empty() && (value < range.front() || value > range.back());
  }
} // namespace retroforge
