// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Limits that the best design misses: by their noise only, where each is missed by no more than its own; and what they
// count after a finer mesh, with the noise, or the tolerance where that is more, on the safe side. And limits that it keeps by luck: designs within a
// tenth of the scales are farther off its slopes than it is from the limit, half a percent of it and three times the noise. Designs farther away, that failed or
// were forged on another mesh, do not count, and less than three say nothing. And what relaxing a limit brings, where the best design has no multiplier; and a best design that
// cannot be forged on the finer mesh: status 2, a headline and why.

#include <retroforge/objective/energy.h>
#include <retroforge/optimization/optimization_results.h>

#include <cmath>
#include <iostream>
#include <sstream>

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

  // g jumps by 0.6 and -0.6 about its slope of 3 per scale; h follows its slope.
  const double scale     = space.scales()[0];
  results.best.mu        = {1.};
  results.best.values    = {1., 9.8, 51.};
  results.best.gradients = {{0.}, {3. / scale}, {-2. / scale}};
  const auto add         = [&](const double part, const double jump, const unsigned int mesh) {
    TrialRow row{TrialRow::Decision::refused, {}};
    row.evaluation.mu     = {1. + part * scale};
    row.evaluation.values = {1., 9.8 + 3. * part + jump, 51. - 2. * part};
    row.mesh              = mesh;
    results.rows.push_back(row);
  };
  const auto by_luck = [&](const char *what) {
    const Neighbours near = results.neighbours();
    std::cout << what << ": " << near.n << " neighbours";
    if (near.n > 0)
      std::cout << ", off by " << std::round(1e6 * near.off[1]) / 1e6 << " and "
                << std::round(1e6 * near.off[2]) / 1e6;
    std::cout << "; by luck:";
    for (const Limit &limit : criteria.limits)
      std::cout << (results.keeps_by_luck(limit) ? " yes" : " no");
    std::cout << "\n";
  };
  results.rows.push_back({TrialRow::Decision::accepted, results.best});
  add(0.09, 0.6, 0);
  add(-0.05, -0.6, 0);
  by_luck("two");
  add(0.11, 5., 0);
  add(0.01, 5., 1);
  results.rows.push_back({TrialRow::Decision::refused, {}});
  by_luck("others that do not count");
  add(0.02, 0.6, 0);
  by_luck("three");
  results.best.values[1]               = 9.3;
  results.rows[0].evaluation.values[1] = 9.3;
  for (TrialRow &row : results.rows)
    if (!row.evaluation.failed() && row.evaluation.mu != results.best.mu)
      row.evaluation.values[1] -= 0.5;
  by_luck("with more room");
  results.best.values[1] = 9.8;
  for (TrialRow &row : results.rows)
    if (!row.evaluation.failed() && row.evaluation.mu != results.best.mu)
      row.evaluation.values[1] += 0.5;
  results.noise.values = {0., 0.3, 0.};
  by_luck("with the noise");
  results.noise = {};
  results.best.gradients.clear();
  by_luck("without slopes");

  // A search that ended for its noise without a multiplier: 9.8 of 10 with a noise of 0.3 says nothing of what relaxing brings.
  results.stop                      = SearchStop::noise;
  results.confirmation->best.values = {1., 9.9, 51.};
  const auto relaxed                = [&](const double g_noise, const std::vector<double> &multipliers) {
    results.noise.values = {0., g_noise, 0.};
    results.multipliers  = multipliers;
    for (std::size_t i = 0; i < 2; ++i)
      std::cout << ' '
                << (std::isnan(results.by_relaxing(i)) ? "unknown" : std::to_string(results.by_relaxing(i)));
  };
  std::cout << "by relaxing:";
  relaxed(0.3, {0., 0.});
  std::cout << "; beyond its noise:";
  relaxed(0.1, {0., 0.});
  std::cout << "; with a multiplier:";
  relaxed(0.3, {20., 0.});
  std::cout << "\nkept on the finer mesh: status " << results.exit_status();
  results.start                      = results.best;
  results.confirmation->start.values = results.best.values;
  results.confirmation->best         = Evaluation();
  results.confirmation->best.failure = "it folds";
  std::ostringstream text;
  results.print(text);
  std::cout << "; not forged there: status " << results.exit_status() << ", told: "
            << (text.str().find("NOT FORGED ON THE FINER MESH") < text.str().find("it folds") ? "yes" : "no")
            << "\n";
}
