// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/optimisation/confidence.h>

#include <deal.II/lac/lapack_full_matrix.h>

#include <cmath>

namespace retroforge
{
  Confidence confidence_of(const Criteria &criteria, const DesignSpace &space, const Evaluation &best)
  {
    Confidence confidence;
    for (unsigned int j = 0; j < space.size(); ++j)
      if (space.at(best.mu, j) == DesignSpace::At::inside)
        confidence.parameters.push_back(j);
    for (const Datum &datum : criteria.data)
      confidence.misfit += std::pow(datum.misfit(best.values), 2);
    const std::size_t n = confidence.parameters.size();
    confidence.freedom  = static_cast<int>(criteria.data.size()) - static_cast<int>(n);
    if (n == 0)
      return confidence;
    dealii::LAPACKFullMatrix<double> normal(n, n);
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = 0; b < n; ++b)
      {
        double sum = 0.;
        for (const Datum &datum : criteria.data)
        {
          const std::vector<double> by_x = space.pull_back(best.gradients[datum.objective]);
          sum += by_x[confidence.parameters[a]] * by_x[confidence.parameters[b]] /
                 (datum.deviation * datum.deviation);
        }
        normal(a, b) = sum;
      }
    dealii::Vector<double>     eigenvalues(n);
    dealii::FullMatrix<double> vectors(n, n);
    // All of them lie in this range: it is symmetric, and positive but for rounding.
    const double largest = normal.frobenius_norm();
    normal.compute_eigenvalues_symmetric(-largest - 1., largest + 1., 0., eigenvalues, vectors);
    constexpr double seen = 1e-12; // of the largest
    if (!(eigenvalues(0) > seen * largest))
    {
      for (std::size_t a = 0; a < n; ++a)
        confidence.unseen.push_back(vectors(a, 0));
      return confidence;
    }
    std::vector<std::vector<double>> covariance(n, std::vector<double>(n, 0.));
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = 0; b < n; ++b)
        for (std::size_t i = 0; i < n; ++i)
          covariance[a][b] += vectors(a, i) * vectors(b, i) / eigenvalues(i);
    for (std::size_t a = 0; a < n; ++a)
      confidence.deviations.push_back(std::sqrt(covariance[a][a]) * space.scales()[confidence.parameters[a]]);
    confidence.correlations = covariance;
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = 0; b < n; ++b)
        confidence.correlations[a][b] /= std::sqrt(covariance[a][a] * covariance[b][b]);
    return confidence;
  }
} // namespace retroforge
