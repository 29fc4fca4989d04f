// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <cmath>
#include <numeric>
#include <vector>

namespace retroforge
{
  // Of a few variables, as an optimisation has.

  inline double dot(const std::vector<double> &x, const std::vector<double> &y)
  {
    return std::inner_product(x.begin(), x.end(), y.begin(), 0.);
  }

  inline double length(const std::vector<double> &x)
  {
    return std::sqrt(dot(x, x));
  }

  /// y += factor x.
  inline void add(const double factor, const std::vector<double> &x, std::vector<double> &y)
  {
    for (std::size_t j = 0; j < y.size(); ++j)
      y[j] += factor * x[j];
  }

  inline std::vector<double> difference(std::vector<double> x, const std::vector<double> &y)
  {
    add(-1., y, x);
    return x;
  }
} // namespace retroforge
