// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/dual.h>

#include <string>
#include <utility>
#include <vector>

namespace retroforge
{
  /// Flow stresses measured over strain, temperature and strain rate. Each strain and temperature has a power
  /// law of the rate,  sigma = sigma_1 e^m,  fitted to its rates by least squares in logarithms (through both,
  /// where there are two); log(sigma_1) and m are interpolated by bicubic Hermite polynomials whose slopes do not
  /// overshoot the data (Fritsch and Butland's, without twist): their first derivatives are continuous.
  /// Beyond the table values are those at its edge.
  class FlowTable
  {
  public:
    /// @param strain, temperature  ascending, dimensionless and [C]
    /// @param log_sigma, m  at strain i and temperature j: entry i * n_temperatures + j
    FlowTable(std::vector<double> strain,
              std::vector<double> temperature,
              std::vector<double> log_sigma,
              std::vector<double> m,
              double              misfit);

    /// Returns (log(sigma_1 / MPa), m).
    template <typename Number>
    std::pair<Number, Number> at(const Number &strain, const Number &temperature) const;

    /// Largest part of a stress in the table by which the fitted power law misses it.
    double misfit() const { return misfit_; }

    double largest_strain() const { return strain_.back(); }
    double least_temperature() const { return temperature_.front(); }
    double largest_temperature() const { return temperature_.back(); }

  private:
    /// Values at the knots, with the slopes of their interpolation.
    struct Surface
    {
      std::vector<double> value, by_strain, by_temperature;
    };

    Surface surface(std::vector<double> values) const;
    template <typename Number>
    Number interpolate(const Surface &of, const Number &strain, const Number &temperature) const;

    std::vector<double> strain_, temperature_;
    Surface             log_sigma_, m_;
    double              misfit_;
  };

  /// Reads a table of comma-separated values with the columns `strain`, `strain rate` [1/s], `temperature` [C]
  /// and `flow stress` [MPa], one row for each of their combinations.
  /// @throws Error  with the line, where a row is missing, a number is none, stresses fall with the rate, or
  ///                are too large for MPa
  FlowTable read_flow_table(const std::string &file);
} // namespace retroforge
