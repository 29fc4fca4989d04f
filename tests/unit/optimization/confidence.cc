// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Deviations of parameters from data, by hand: two data for two parameters; one datum for two that a relation
// ties together, and without the relation; a parameter at its bound.

#include <retroforge/objective/energy.h>
#include <retroforge/optimization/confidence.h>

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

  bool is_near(const double x, const double y)
  {
    return std::abs(x - y) < 1e-12 * std::abs(y);
  }

  /// Data u = a + b, known to 0.1, and v = a - b, known to 0.2, of parameters a and b with the scales 1
  /// and 2.
  Confidence confidence(const std::vector<std::string>      &data,
                        const std::string                   &relation,
                        const std::map<std::string, double> &lower = {})
  {
    OptimizationParameters parameters;
    parameters.scales = {{"a", 1.}, {"b", 2.}};
    if (!relation.empty())
      parameters.relations = {relation};
    for (const auto &[name, bound] : lower)
      parameters.lower.emplace(name, bound);
    Objectives objectives(2);
    for (unsigned int o = 0; o < 2; ++o)
    {
      objectives[o].name = o == 0 ? "u" : "v";
      objectives[o].path = std::make_unique<EnergyObjective>();
    }
    for (const std::string &name : data)
    {
      parameters.data.emplace(name, name == "u" ? 6. : 0.);
      parameters.uncertainties.emplace(name, name == "u" ? 0.1 : 0.2);
    }
    const std::vector<double>          mu  = {3., 3.};
    const std::vector<DesignParameter> all = {{"a", "mm", Kind::billet, 3., 1.},
                                              {"b", "mm", Kind::billet, 3., 1.}};
    const DesignSpace                  space(all, {"a", "b"}, mu, parameters);
    const Criteria                     criteria(objectives, parameters);
    Evaluation                         best;
    best.mu        = mu;
    best.values    = {6.05, 0.};
    best.gradients = {{1., 1.}, {1., -1.}};
    return confidence_of(criteria, space, best);
  }
} // namespace

int main()
{
  // a = (u + v) / 2, b = (u - v) / 2.
  const Confidence both      = confidence({"u", "v"}, "");
  const double     deviation = 0.5 * std::hypot(0.1, 0.2);
  std::cout << "two data: deviations "
            << answer(is_near(both.deviations[0], deviation) && is_near(both.deviations[1], deviation))
            << ", correlation " << answer(is_near(both.correlations[0][1], (0.01 - 0.04) / (0.01 + 0.04)))
            << ", freedom " << both.freedom << ", misfit " << answer(is_near(both.misfit, 0.25)) << "\n";
  const Confidence tied = confidence({"u"}, "a = b");
  std::cout << "one datum and a = b: seen " << answer(tied.unseen.empty()) << ", deviations "
            << answer(is_near(tied.deviations[0], 0.05) && is_near(tied.deviations[1], 0.05))
            << ", correlation " << answer(is_near(tied.correlations[0][1], 1.)) << ", freedom "
            << tied.freedom << "\n";
  // a changes by -2 where b changes by 2, in scales by -2 and 1.
  const Confidence blind = confidence({"u"}, "");
  std::cout << "one datum alone: unseen "
            << answer(blind.unseen.size() == 2 && is_near(blind.unseen[0], -2. * blind.unseen[1]))
            << ", freedom " << blind.freedom << "\n";
  const Confidence held = confidence({"u"}, "", {{"b", 3.}});
  std::cout << "one datum and b at its bound: parameters " << held.parameters.size() << ", deviation "
            << answer(is_near(held.deviations[0], 0.1)) << "\n";
}
