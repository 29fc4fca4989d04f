// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/case/optimization_parameters.h>
#include <retroforge/design/design.h>
#include <retroforge/optimization/journal.h>

namespace retroforge
{
  /// A design parameter that a workshop does not hold: it lies evenly in a range. Of each objective counts
  /// mean + lambda sigma  over the points of a Gauss quadrature, or  mean - lambda sigma  where a limit is a
  /// lower one.
  class Scatter
  {
  public:
    /// None: one sample, as it is.
    Scatter() = default;
    /// @param from_below  objectives that may not be smaller than a limit
    /// @throws Error  for a parameter that is not among those, or a range that it may not have
    Scatter(const std::vector<DesignParameter> &parameters,
            const OptimizationParameters       &optimization,
            std::vector<bool>                   from_below);

    bool empty() const { return values_.empty(); }
    /// Returns the statistic of an objective over the samples; empty without samples.
    std::string in_words() const;
    std::size_t n_samples() const { return empty() ? 1 : values_.size(); }
    /// Returns the value of the scattered parameter in one sample.
    double value(const std::size_t sample) const { return values_[sample]; }

    /// The design as it is forged in a sample.
    std::vector<double> sample(std::vector<double> mu, std::size_t i) const;

    /// Combines the samples. Where one has failed, all have. The derivative by the scattered parameter is
    /// that of moving the whole range.
    Evaluation combined(const std::vector<double> &mu, const std::vector<Evaluation> &samples) const;

  private:
    void combine_values(const std::vector<Evaluation> &samples, Evaluation &all) const;
    void combine_gradients(const std::vector<Evaluation> &samples, Evaluation &all) const;

    std::string         name_;
    std::size_t         parameter_ = 0;
    std::vector<double> values_, weights_;
    std::vector<bool>   from_below_;
    double              deviations_ = 0.;
  };
} // namespace retroforge
