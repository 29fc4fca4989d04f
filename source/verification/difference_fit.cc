// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/verification/difference_fit.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    constexpr double last_digits = 1e-15;

    struct Samples
    {
      std::vector<double> h, d;
      double              floor; ///< of J
    };

    double size(const Samples &samples, const std::size_t k, const double J, const double C)
    {
      return std::max(J, samples.floor) / samples.h[k] + C * samples.h[k];
    }

    double misfit(const Samples &samples, const double slope, const double J, const double C)
    {
      double sum = 0.;
      for (std::size_t k = 0; k < samples.h.size(); ++k)
      {
        const double s = size(samples, k, J, C);
        sum += std::log(s) + std::abs(samples.d[k] - slope) / s;
      }
      return sum;
    }

    /// Sizes to try: none, and from the least that matters to the largest, in eighths of a decade.
    std::vector<double> sizes(const double least, const double most)
    {
      std::vector<double> sizes = {0.};
      const double        ratio = std::pow(10., 0.125);
      for (double x = least; x < most * ratio; x *= ratio)
        sizes.push_back(x);
      return sizes;
    }
  } // namespace

  DifferenceFit
  DifferenceFit::of(const std::vector<double> &steps, const std::vector<double> &d, const double value)
  {
    Samples samples;
    for (std::size_t k = 0; k < d.size(); ++k)
      if (!std::isnan(d[k]))
      {
        samples.h.push_back(steps[k]);
        samples.d.push_back(d[k]);
      }
    if (samples.h.size() < 3)
      return {};
    const auto [lowest, highest]   = std::minmax_element(samples.d.begin(), samples.d.end());
    const auto [shortest, longest] = std::minmax_element(samples.h.begin(), samples.h.end());
    const double largest           = std::max(std::abs(*lowest), std::abs(*highest));
    samples.floor = std::max({last_digits * std::abs(value), last_digits * largest * *longest, 1e-300});
    const double  spread = *highest - *lowest;
    double        best = std::numeric_limits<double>::max(), C_best = 0.;
    DifferenceFit fit;
    for (const double J : sizes(samples.floor, spread * *longest))
      for (const double C : sizes(last_digits * std::max(largest, 1e-300) / *longest, spread / *shortest))
        for (const double slope : samples.d)
          if (const double of_these = misfit(samples, slope, J, C); of_these < best)
          {
            best      = of_these;
            fit.slope = slope;
            fit.jump  = 2. * std::max(J, samples.floor);
            C_best    = C;
          }
    fit.uncertainty = std::numeric_limits<double>::max();
    for (std::size_t k = 0; k < samples.h.size(); ++k)
      fit.uncertainty = std::min(fit.uncertainty, 2. * size(samples, k, 0.5 * fit.jump, C_best));
    return fit;
  }
} // namespace retroforge
