// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/design/design.h>
#include <retroforge/optimisation/optimisation_parameters.h>

namespace retroforge
{
  /// The design parameters as an optimiser sees them: changes from the start in units of their scales,
  /// x_j = (mu_j - start_j) / scale_j,  between bounds. Those that are not varied stay where they start.
  class DesignSpace
  {
  public:
    /// @param varied  names of the parameters that an optimiser may change
    /// @param start   values where the optimisation begins
    /// @throws Error  for names that are not among the parameters, bounds that cross, a start outside of them
    DesignSpace(const std::vector<DesignParameter> &parameters,
                const std::vector<std::string>     &varied,
                const std::vector<double>          &start,
                const OptimisationParameters       &optimisation);

    std::size_t                         size() const { return start_.size(); }
    const std::vector<DesignParameter> &parameters() const { return parameters_; }
    const std::vector<double>          &start() const { return start_; }
    const std::vector<double>          &scales() const { return scales_; }
    const std::vector<double>          &lower() const { return lower_; } ///< of mu
    const std::vector<double>          &upper() const { return upper_; }

    /// Bounds of x.
    std::vector<double> scaled_lower() const { return scaled(lower_); }
    std::vector<double> scaled_upper() const { return scaled(upper_); }

    std::vector<double> scaled(const std::vector<double> &mu) const;
    /// mu(x), within its bounds in spite of rounding.
    std::vector<double> values(const std::vector<double> &x) const;
    /// d/dx from d/dmu.
    std::vector<double> pull_back(const std::vector<double> &by_mu) const;

    enum class At
    {
      fixed, ///< not varied
      inside,
      lower,
      upper
    };
    At at(const std::vector<double> &mu, std::size_t j) const;
    /// Length of  P(x - g) - x,  with P onto the bounds: 0 at an optimum.
    double projected_length(const std::vector<double> &mu, const std::vector<double> &by_mu) const;

  private:
    std::vector<DesignParameter> parameters_;
    std::vector<double>          start_, scales_, lower_, upper_;
  };
} // namespace retroforge
