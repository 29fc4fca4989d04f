// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/scan/line_statistics.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    double mean(const std::vector<double> &x)
    {
      double sum = 0.;
      for (const double value : x)
        sum += value;
      return x.empty() ? LineStatistics::unknown : sum / x.size();
    }

    /// Root of the mean square, and the largest, over |size|.
    std::pair<double, double> relative(const std::vector<double> &deviations, const double size)
    {
      double square = 0., largest = 0.;
      for (const double d : deviations)
      {
        square += d * d;
        largest = std::max(largest, std::abs(d));
      }
      if (deviations.empty() || size == 0.)
        return {LineStatistics::unknown, LineStatistics::unknown};
      return {std::sqrt(square / deviations.size()) / std::abs(size), largest / std::abs(size)};
    }
  } // namespace

  std::optional<PolynomialFit> ScannedLine::fit(const unsigned int degree) const
  {
    std::vector<double> at, values;
    for (std::size_t i = 0; i < x.size(); ++i)
      if (!std::isnan(y[i]))
      {
        at.push_back(x[i]);
        values.push_back(y[i]);
      }
    if (at.size() < degree + 2)
      return std::nullopt;
    return PolynomialFit(at, values, degree);
  }

  LineStatistics::LineStatistics(const ScannedLine &line, const std::optional<PolynomialFit> &fit)
  {
    std::vector<double> values, off_fit, slopes, off_slope, fit_slopes, fit_slopes_of_values;
    for (std::size_t i = 0; i < line.x.size(); ++i)
    {
      if (std::isnan(line.y[i]))
        continue;
      values.push_back(line.y[i]);
      const bool has_slope = !std::isnan(line.slopes[i]);
      if (has_slope)
        slopes.push_back(line.slopes[i]);
      if (!fit)
        continue;
      off_fit.push_back(line.y[i] - fit->value(line.x[i]));
      fit_slopes_of_values.push_back(fit->slope(line.x[i]));
      if (has_slope)
      {
        fit_slopes.push_back(fit_slopes_of_values.back());
        off_slope.push_back(line.slopes[i] - fit_slopes.back());
      }
    }
    n_values   = values.size();
    n_slopes   = slopes.size();
    mean_value = mean(values);
    mean_slope = mean(slopes);
    if (!fit)
      return;
    mean_fit_slope = mean(slopes.empty() ? fit_slopes_of_values : fit_slopes);
    // An objective that a parameter does not change has a fit whose slope is rounding: nothing is told by ratios to it.
    constexpr double rounding   = 1e-12;
    const auto [least, largest] = std::minmax_element(line.x.begin(), line.x.end());
    const bool   is_flat = std::abs(mean_fit_slope) * (*largest - *least) <= rounding * std::abs(mean_value);
    const double size    = is_flat ? 0. : mean_fit_slope;
    bias                 = slopes.empty() || size == 0. ? unknown : mean_slope / size - 1.;
    std::tie(noise_rms, noise_max)         = relative(off_fit, mean_value);
    std::tie(roughness_rms, roughness_max) = relative(off_slope, size);
  }
} // namespace retroforge
