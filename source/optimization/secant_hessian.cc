// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/optimization/secant_hessian.h>
#include <retroforge/optimization/small_vectors.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  std::vector<double> SecantHessian::times(const std::vector<double> &v) const
  {
    if (matrix_.empty())
      return v;
    AssertDimension(v.size(), matrix_.n());
    std::vector<double> product(v.size(), 0.);
    for (unsigned int i = 0; i < v.size(); ++i)
      for (unsigned int j = 0; j < v.size(); ++j)
        product[i] += matrix_(i, j) * v[j];
    return product;
  }

  void
  SecantHessian::learn(const std::vector<double> &step, const std::vector<double> &change, const double noise)
  {
    AssertDimension(step.size(), change.size());
    const double ss = dot(step, step), sy = dot(step, change);
    if (std::max(std::abs(sy), std::abs(dot(step, times(step)))) <= noise)
      return;
    const auto n = static_cast<unsigned int>(step.size());
    if (matrix_.empty())
    {
      matrix_.reinit(n, n);
      for (unsigned int i = 0; i < n; ++i)
        matrix_(i, i) = sy > 0. ? dot(change, change) / sy : 1.;
    }
    const std::vector<double> bent = times(step), missing = difference(change, bent);
    const double              sbs = dot(step, bent), along = dot(missing, step);
    constexpr double          least  = 0.2; // cosine or part: noise must not grow without bound
    const bool                rank_1 = std::abs(along) > least * length(missing) * std::sqrt(ss);
    const bool                rank_2 =
      n > most_of_rank_1 && sbs > 0. && sy >= least * sbs && sy >= least * length(change) * std::sqrt(ss);
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        matrix_(i, j) +=
          rank_2   ? change[i] * change[j] / sy - bent[i] * bent[j] / sbs
          : rank_1 ? missing[i] * missing[j] / along
                   : (missing[i] * step[j] + step[i] * missing[j] - along * step[i] * step[j] / ss) / ss;
  }
} // namespace retroforge
