// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The augmented Lagrangian: zero at the start but for limits that are exceeded, its gradient by differences,
// and multipliers of a problem whose are known.

#include <retroforge/objective/energy.h>
#include <retroforge/objective/volume.h>
#include <retroforge/optimization/merit.h>

#include <cmath>
#include <iostream>

using namespace retroforge;

namespace
{
  const char *answer(const bool yes)
  {
    return yes ? "yes" : "NO";
  }

  /// Three objectives of two parameters.
  std::vector<double> values_at(const std::vector<double> &mu)
  {
    return {mu[0] * mu[0] + 2. * mu[1], std::sin(mu[0]) * mu[1], mu[0] - mu[1] * mu[1]};
  }

  std::vector<std::vector<double>> gradients_at(const std::vector<double> &mu)
  {
    return {{2. * mu[0], 2.}, {std::cos(mu[0]) * mu[1], std::sin(mu[0])}, {1., -2. * mu[1]}};
  }

  Criteria criteria()
  {
    Objectives objectives(3);
    for (unsigned int o = 0; o < 3; ++o)
    {
      objectives[o].name   = std::string(1, 'a' + o);
      objectives[o].weight = 1. + o;
      objectives[o].path   = std::make_unique<EnergyObjective>();
    }
    OptimizationParameters parameters;
    parameters.at_most.emplace("b", 0.2);
    parameters.at_least.emplace("c", -0.5);
    return {objectives, parameters};
  }

  double difference_error(const Merit &merit, const std::vector<double> &mu)
  {
    const std::vector<double> gradient = merit.gradient(values_at(mu), gradients_at(mu));
    double                    largest  = 0.;
    for (unsigned int j = 0; j < 2; ++j)
    {
      constexpr double    step = 1e-5;
      std::vector<double> up = mu, down = mu;
      up[j] += step;
      down[j] -= step;
      const double difference = (merit.value(values_at(up)) - merit.value(values_at(down))) / (2. * step);
      largest                 = std::max(largest, std::abs(difference - gradient[j]) / std::abs(gradient[j]));
    }
    return largest;
  }
} // namespace

int main()
{
  const Criteria            all = criteria();
  const std::vector<double> mu = {0.7, 0.9}, start = values_at(mu);
  std::cout << "what has no limit is made small: " << all.objective.name << ", weight "
            << all.objective.weights[0] << "\nlimits: " << all.limits.size() << "\n";

  Merit merit{&all, start[0], 3., {0., 0.}, {5., 2.}};
  std::cout << "b exceeds its limit, c does not: "
            << answer(all.limits[0].excess(start) > 0. && all.limits[1].excess(start) < 0.) << "\n";
  const double pressed = 5. * all.limits[0].excess(start);
  std::cout << "at the start only what is exceeded counts: "
            << answer(std::abs(merit.value(start) - pressed * pressed / 10.) < 1e-14) << "\n";
  std::cout << "gradient by differences to 1e-8: " << answer(difference_error(merit, mu) < 1e-8) << "\n";
  merit.multipliers = {0.3, 20.};
  std::cout << "and with multipliers that press both: " << answer(difference_error(merit, mu) < 1e-8) << "\n";

  // g + 2 a + 0 b = 0 in its first two numbers; the multiplier of b would be negative.
  const auto lambda = least_squares_multipliers({-2., -4., 0.3}, {{1., 2., 0.}, {0., 0., 1.}});
  std::cout << "multipliers: " << answer(std::abs(lambda[0] - 2.) < 1e-14 && lambda[1] == 0.) << "\n";
  const auto close = [](const std::vector<double> &x, const std::vector<double> &y) {
    double largest = 0.;
    for (std::size_t i = 0; i < x.size(); ++i)
      largest = std::max(largest, std::abs(x[i] - y[i]));
    return answer(x.size() == y.size() && largest < 1e-14);
  };
  std::cout << "a limit that the design does not move: "
            << close(least_squares_multipliers({-2., -4., 0.3}, {{0., 0., 0.}, {1., 2., 0.}}), {0., 2.})
            << "\none that is named twice: "
            << close(least_squares_multipliers({-2., -4., 0.3}, {{1., 2., 0.}, {1., 2., 0.}}), {1., 1.})
            << "\nmore limits than the design has directions: "
            << close(least_squares_multipliers({-5.}, {{1.}, {2.}}), {1., 2.}) << "\n";
}
