// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Scaled design parameters: there and back, at their bounds to the bit; those that are not varied stay; what
// cannot be is refused.

#include <retroforge/core/error.h>
#include <retroforge/optimization/design_space.h>

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

  const std::vector<DesignParameter> parameters = {{"billet/radius", "mm", Kind::billet, 20., 20.},
                                                   {"material/K", "MPa s^m", Kind::material, 2., 2.},
                                                   {"die upper/offset", "mm", Kind::offset, 0., 40.}};
  const std::vector<std::string>     varied     = {"billet/radius", "die upper/offset"};

  template <typename Change>
  void refuse(const std::string &what, const Change &change)
  {
    OptimizationParameters optimization;
    change(optimization);
    try
    {
      optimization.check();
      DesignSpace(parameters, varied, {20., 2., 0.}, optimization);
      std::cout << what << ": NOT REFUSED\n";
    }
    catch (const Error &error)
    {
      std::cout << what << ": " << error.what() << "\n";
    }
  }
} // namespace

int main()
{
  OptimizationParameters optimization;
  optimization.lower.emplace("billet/radius", 17.1);
  optimization.upper.emplace("billet/radius", 23.3);
  optimization.scales.emplace("billet/radius", 0.7);
  const std::vector<double> start = {20., 2., 0.};
  const DesignSpace         space(parameters, varied, start, optimization);

  {
    // A parameter of scale 1 and one of scale 2, from (1, 3): by hand on paper.
    OptimizationParameters related;
    related.scales    = {{"billet/radius", 1.}, {"die upper/offset", 2.}};
    related.lower     = {{"billet/radius", 0.5}};
    related.relations = {"2 billet/radius - die upper/offset <= 1",
                         "- die upper/offset + 3 * billet/radius = 0"};
    const DesignSpace two(parameters, varied, {1., 2., 3.}, related);
    const auto       &of_mu = two.relations()[0], &of_x = two.scaled_relations()[0];
    std::cout << "a relation: " << of_mu.weights[0] << ' ' << of_mu.weights[2] << " to " << of_mu.upper
              << "; of x: " << of_x.weights[0] << ' ' << of_x.weights[2] << " to " << of_x.upper << '\n';
    // 3 x_0 = 2 x_2 : a point off it goes to the nearest on it; one far down to where the bound ends it.
    const std::vector<double> near = two.projected({0., 0., 1.}), low = two.projected({-5., 0., -5.});
    std::cout << "nearest on a line: " << near[0] * 13. << ' ' << near[2] * 13. << "; at its end: " << low[0]
              << ' ' << low[2] << '\n';
    const auto free = two.free_directions({1., 2., 3.});
    std::cout << "one direction is free: "
              << answer(free.size() == 1 && std::abs(free[0][2] / free[0][0] - 1.5) < 1e-14)
              << "; none at the bound: " << answer(two.free_directions({0.5, 2., 1.5}).empty()) << '\n';
    // f = 6 mu_0 + 0 mu_2 over x: (6, 0) = nu (3, -2) + what is free.
    const std::vector<double> slopes = slopes_of_relations(two, {2., 2., 6.}, {6., 0., 0.});
    std::cout << "slopes of relations: " << slopes[0] << ' ' << slopes[1] << '\n';
  }

  const std::vector<double> mu = {18.3, 2., -1.1}, x = space.scaled(mu), back = space.values(x);
  double                    error = 0.;
  for (unsigned int j = 0; j < 3; ++j)
    error = std::max(error, std::abs(back[j] - mu[j]));
  std::cout << "there and back to 1e-14: " << answer(error < 1e-14) << "\nscales: " << space.scales()[0]
            << ' ' << space.scales()[2] << "\nstart is zero, to the bit: "
            << answer(space.scaled(start) == std::vector<double>(3, 0.) &&
                      space.values({0., 0., 0.}) == start)
            << "\nbounds are met to the bit: "
            << answer(space.values(space.scaled_lower())[0] == 17.1 &&
                      space.values(space.scaled_upper())[0] == 23.3)
            << "\nwhat is not varied stays: "
            << answer(space.values({0., 5., 0.})[1] == 2. && space.at(mu, 1) == DesignSpace::At::fixed)
            << "\nat a bound: "
            << answer(space.at({17.1, 2., 0.}, 0) == DesignSpace::At::lower &&
                      space.at(mu, 0) == DesignSpace::At::inside)
            << "\n";
  const std::vector<double> g = space.pull_back({3., 4., 0.5});
  std::cout << "gradient: " << answer(g[0] == 3. * 0.7 && g[2] == 0.5 * space.scales()[2])
            << "\nprojected at the bound it presses against: "
            << answer(std::abs(space.projected_length({17.1, 2., 0.}, {3., 4., 0.5}) - g[2]) < 1e-14)
            << "\nand where it points inwards: "
            << answer(std::abs(space.projected_length({17.1, 2., 0.}, {-3., 4., 0.}) - 3. * 0.7) < 1e-14)
            << "\n";

  refuse("unknown bound", [](auto &o) { o.lower.emplace("billet/raduis", 1.); });
  refuse("bound of what is not varied", [](auto &o) { o.upper.emplace("material/K", 3.); });
  refuse("twice", [](auto &o) {
    o.upper.emplace("billet/radius", 23.);
    o.upper.emplace("billet/radius", 24.);
  });
  refuse("crossed", [](auto &o) {
    o.lower.emplace("billet/radius", 23.);
    o.upper.emplace("billet/radius", 22.);
  });
  refuse("start outside", [](auto &o) { o.lower.emplace("billet/radius", 21.); });
  refuse("scale", [](auto &o) { o.scales.emplace("billet/radius", -1.); });
  refuse("first step", [](auto &o) { o.first_step = 5., o.largest_step = 4.; });
  refuse("a relation without comparison",
         [](OptimizationParameters &o) { o.relations = {"billet/radius + 1"}; });
  refuse("a misspelt name in a relation",
         [](OptimizationParameters &o) { o.relations = {"billet/radus <= 30"}; });
  refuse("a relation that does not hold",
         [](OptimizationParameters &o) { o.relations = {"billet/radius <= 19"}; });
  refuse("a strict one", [](OptimizationParameters &o) { o.relations = {"billet/radius < 30"}; });
  refuse("two comparisons", [](OptimizationParameters &o) { o.relations = {"1 <= billet/radius <= 30"}; });
  refuse("an empty term", [](OptimizationParameters &o) { o.relations = {"billet/radius + <= 30"}; });
  refuse("one of nothing",
         [](OptimizationParameters &o) { o.relations = {"billet/radius <= billet/radius"}; });
  refuse("one of what stays", [](OptimizationParameters &o) { o.relations = {"material/K <= 3"}; });
}
