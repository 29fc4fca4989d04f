// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/optimization/confidence.h>

#include <deal.II/lac/lapack_full_matrix.h>

#include <cmath>
#include <numeric>

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
    // Neither bounds that hold nor relations leave a design all directions.
    const std::vector<std::vector<double>> free = space.free_directions(best.mu);
    const std::size_t                      n    = free.size();
    confidence.freedom = static_cast<int>(criteria.data.size()) - static_cast<int>(n);
    if (n == 0)
    {
      confidence.parameters.clear();
      return confidence;
    }
    dealii::Vector<double>           eigenvalues(n);
    dealii::FullMatrix<double>       vectors(n, n);
    dealii::LAPACKFullMatrix<double> normal(n, n);
    for (const Datum &datum : criteria.data)
    {
      const std::vector<double> by_x = space.pull_back(best.gradients[datum.objective]);
      std::vector<double>       row;
      for (const std::vector<double> &direction : free)
        row.push_back(std::inner_product(direction.begin(), direction.end(), by_x.begin(), 0.) /
                      datum.deviation);
      for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b)
          normal(a, b) += row[a] * row[b];
    }
    /// The change of a parameter by a combination of free directions.
    const auto changed = [&](const unsigned int parameter, const std::size_t combination) {
      double sum = 0.;
      for (std::size_t d = 0; d < n; ++d)
        sum += free[d][parameter] * vectors(d, combination);
      return sum;
    };
    // All of them lie in this range: it is symmetric, and positive but for rounding.
    const double largest = normal.frobenius_norm();
    normal.compute_eigenvalues_symmetric(-largest - 1., largest + 1., 0., eigenvalues, vectors);
    constexpr double seen = 1e-12; // of the largest
    if (!(eigenvalues(0) > seen * largest))
    {
      for (const unsigned int j : confidence.parameters)
        confidence.unseen.push_back(changed(j, 0));
      return confidence;
    }
    const std::size_t                m = confidence.parameters.size();
    std::vector<std::vector<double>> covariance(m, std::vector<double>(m, 0.));
    for (std::size_t a = 0; a < m; ++a)
      for (std::size_t b = 0; b < m; ++b)
        for (std::size_t i = 0; i < n; ++i)
          covariance[a][b] +=
            changed(confidence.parameters[a], i) * changed(confidence.parameters[b], i) / eigenvalues(i);
    for (std::size_t a = 0; a < m; ++a)
      confidence.deviations.push_back(std::sqrt(covariance[a][a]) * space.scales()[confidence.parameters[a]]);
    confidence.correlations = covariance;
    for (std::size_t a = 0; a < m; ++a)
      for (std::size_t b = 0; b < m; ++b)
        // One that relations fix has no deviation.
        if (const double both = std::sqrt(covariance[a][a] * covariance[b][b]); both > 0.)
          confidence.correlations[a][b] /= both;
    return confidence;
  }
} // namespace retroforge
