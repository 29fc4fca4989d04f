// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/scan/polynomial_fit.h>

#include <limits>
#include <optional>
#include <vector>

namespace retroforge
{
  /// One objective along one parameter x: values y, and local slopes; NaN where there is none.
  struct ScannedLine
  {
    std::vector<double> x, y, slopes;

    /// Through the points that have a value; none where these are too few.
    std::optional<PolynomialFit> fit(unsigned int degree) const;
  };

  /// How a line differs from its smooth fit f. Deviations are over the points, ratios dimensionless; NaN
  /// where nothing is known or a ratio has no denominator.
  struct LineStatistics
  {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    unsigned int n_values = 0, n_slopes = 0;
    double       mean_value     = unknown;
    double       noise_rms      = unknown; ///< of y - f, over |mean of y|
    double       noise_max      = unknown;
    double       mean_slope     = unknown; ///< of the local slopes
    double       mean_fit_slope = unknown; ///< of f', where there are local slopes or else values
    double       bias           = unknown; ///< mean_slope / mean_fit_slope - 1
    double       roughness_rms  = unknown; ///< of slope - f', over |mean_fit_slope|
    double       roughness_max  = unknown;

    LineStatistics() = default;
    LineStatistics(const ScannedLine &line, const std::optional<PolynomialFit> &fit);
  };
} // namespace retroforge
