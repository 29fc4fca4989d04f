// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Limits that the best design misses: by their noise only, where each is missed by no more than its own; and what they
// count after a finer mesh, with the noise, or the tolerance where that is more, on the safe side.

#include <retroforge/objective/energy.h>
#include <retroforge/optimization/optimization_results.h>

#include <cmath>
#include <iostream>

using namespace retroforge;

int main()
{
  Objectives objectives(3);
  for (unsigned int o = 0; o < 3; ++o)
  {
    objectives[o].name = std::vector<std::string>{"f", "g", "h"}[o];
    objectives[o].path = std::make_unique<EnergyObjective>();
  }
  OptimizationParameters parameters;
  parameters.objective                   = {"f"};
  parameters.at_most                     = {{"g", 10.}};
  parameters.at_least                    = {{"h", 50.}};
  const std::vector<DesignParameter> all = {{"a", "mm", DesignParameter::Kind::billet, 1., 1.}};
  const DesignSpace                  space(all, {"a"}, {1.}, parameters);
  const Criteria                     criteria(objectives, parameters);
  OptimizationResults                results{space, criteria, {"f", "g", "h"}, {"mJ", "mm", "C"}};
  results.limit_tolerance = 1e-4;

  const auto by_noise = [&](const double g, const double h) {
    results.best.values = {1., g, h};
    return results.missed_only_by_noise() ? "yes" : "no";
  };
  std::cout << "no noise known: " << by_noise(10.2, 51.) << "\n";
  results.noise.values = {0., 0.3, 0.5};
  std::cout << "kept: " << by_noise(9.9, 51.) << ", within the tolerance: " << by_noise(10.0005, 51.)
            << ", one within its noise: " << by_noise(10.2, 51.) << ", both: " << by_noise(10.2, 49.6)
            << ", one beyond its own: " << by_noise(10.4, 49.6) << ", " << by_noise(10.2, 49.4) << "\n";

  results.best.values               = {1., 10., 50.};
  results.confirmation              = Confirmation();
  results.confirmation->best.values = {1., 11., 48.};
  const auto corrections            = [&] {
    for (const Limit &limit : criteria.limits)
      std::cout << ' ' << std::round(1e6 * results.correction_there(limit)) / 1e6;
    std::cout << "\n";
  };
  std::cout << "counts with";
  corrections();
  results.noise = {};
  std::cout << "without noise";
  corrections();
}
