// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/optimization/noise_estimate.h>

#include <cmath>
#include <random>

namespace retroforge
{
  std::vector<double> predicted_values(const Evaluation &from, const std::vector<double> &mu)
  {
    std::vector<double> values = from.values;
    for (std::size_t o = 0; o < from.gradients.size(); ++o)
      for (std::size_t j = 0; j < mu.size(); ++j)
        values[o] += from.gradients[o][j] * (mu[j] - from.mu[j]);
    return values;
  }

  Noise measure_noise(OptimizationProblem                                             &problem,
                      const Evaluation                                                &at,
                      const std::function<void(const Evaluation &evaluation, double)> &tell)
  {
    constexpr double              part       = 1e-3; // of the scales: what bends over it is no noise
    const OptimizationParameters &parameters = problem.parameters();
    const Criteria               &criteria   = problem.criteria;
    std::mt19937                  generator(1);
    const std::vector<double>     middle = problem.space.scaled(at.mu);
    Noise                         noise{0., std::vector<double>(at.values.size(), 0.)}; // squares first
    for (unsigned int i = 0;
         i < parameters.noise_runs && problem.evaluator.n_asked() < parameters.simulations;
         ++i)
    {
      std::vector<double> x = middle;
      for (double &entry : x)
        entry += part * (2. * (generator() / 4294967295.) - 1.);
      const std::vector<double> mu         = problem.space.values(problem.space.projected(x));
      const Evaluation          evaluation = problem.evaluate(mu);
      tell(evaluation, part);
      if (evaluation.failed())
        continue;
      // Values are linear over so short a step; their misfit against data need not be.
      const std::vector<double> predicted = predicted_values(at, mu);
      noise.objective += std::pow(criteria.value(evaluation.values) - criteria.value(predicted), 2);
      for (std::size_t o = 0; o < predicted.size(); ++o)
        noise.values[o] += std::pow(evaluation.values[o] - predicted[o], 2);
      ++noise.n_designs;
    }
    if (noise.n_designs == 0)
      return noise;
    noise.objective = std::sqrt(noise.objective / noise.n_designs);
    for (double &value : noise.values)
      value = std::sqrt(value / noise.n_designs);
    return noise;
  }
} // namespace retroforge
