// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// A scattered parameter: mean and standard deviation over its samples, against closed forms; their gradient
// by differences; of a failed sample the reason; without scatter everything as it is.

#include <retroforge/optimization/scatter.h>

#include <cmath>
#include <iostream>

using namespace retroforge;

namespace
{
  using Kind = DesignParameter::Kind;

  const char *answer(const bool yes)
  {
    return yes ? "yes" : "NO";
  }

  const std::vector<DesignParameter> parameters = {{"billet/radius", "mm", Kind::billet, 2., 2.},
                                                   {"dies/friction", "", Kind::friction, 0.3, 0.3}};

  /// Two objectives of two parameters.
  Evaluation forged(const std::vector<double> &mu)
  {
    Evaluation evaluation;
    evaluation.mu        = mu;
    evaluation.values    = {mu[0] * mu[1], std::sin(mu[0]) + mu[1] * mu[1]};
    evaluation.gradients = {{mu[1], mu[0]}, {std::cos(mu[0]), 2. * mu[1]}};
    return evaluation;
  }

  Evaluation over(const Scatter &scatter, const std::vector<double> &mu)
  {
    std::vector<Evaluation> samples;
    for (std::size_t i = 0; i < scatter.n_samples(); ++i)
      samples.push_back(forged(scatter.sample(mu, i)));
    return scatter.combined(mu, samples);
  }
} // namespace

int main()
{
  OptimizationParameters optimization;
  optimization.scattered     = "dies/friction";
  optimization.scatter_range = {0.2, 0.6};
  optimization.deviations    = 2.;
  const Scatter             scatter(parameters, optimization, {false, true});
  const std::vector<double> mu = {2., 0.3};

  // Of r f with f even in [0.2, 0.6]: mean 0.4 r, deviation 0.4 r / sqrt(12).
  const Evaluation all = over(scatter, mu);
  std::cout << "samples: " << scatter.n_samples() << "\nmean and deviation: "
            << answer(std::abs(all.values[0] - (0.8 + 2. * 0.8 / std::sqrt(12.))) < 1e-14) << "\n";
  // Of f^2, three points are exact to the fifth degree, and its variance is of the fourth.
  const double mean = (0.216 - 0.008) / 1.2, square = (std::pow(0.6, 5) - std::pow(0.2, 5)) / 2.;
  std::cout << "less the deviation where the limit is a lower one: "
            << answer(std::abs(all.values[1] - (std::sin(2.) + mean - 2. * std::sqrt(square - mean * mean))) <
                      1e-14)
            << "\n";

  double error = 0.;
  for (unsigned int o = 0; o < 2; ++o)
  {
    constexpr double step = 1e-5;
    const double     difference =
      (over(scatter, {2. + step, 0.3}).values[o] - over(scatter, {2. - step, 0.3}).values[o]) / (2. * step);
    error = std::max(error, std::abs(difference - all.gradients[o][0]));
  }
  std::cout << "gradient by differences to 1e-9: " << answer(error < 1e-9) << "\n";

  Evaluation failed;
  failed.failure           = "an element would be inverted";
  const Evaluation reasons = scatter.combined(mu, {forged(mu), failed});
  std::cout << "failed: " << answer(reasons.failed()) << ", " << reasons.failure << "\n";

  // What does not depend on the scattered parameter has no deviation, whatever rounding makes of its mean.
  Evaluation constant;
  constant.values          = {0.1, 1. / 3.};
  constant.gradients       = {{1. / 7., 0.}, {0.3, 0.}};
  const Evaluation without = scatter.combined(mu, {constant, constant, constant});
  std::cout << "the same in all samples: "
            << answer(without.values == constant.values &&
                      std::abs(without.gradients[0][0] - 1. / 7.) < 1e-15 &&
                      std::abs(without.gradients[1][0] - 0.3) < 1e-15)
            << "\n";

  const Evaluation as_it_is = over(Scatter(), mu);
  std::cout << "no scatter: " << answer(as_it_is.values == forged(mu).values && Scatter().sample(mu, 0) == mu)
            << "\n";
}
