// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Scaled design parameters: there and back, at their bounds to the bit; those that are not varied stay; what
// cannot be is refused.

#include <retroforge/core/error.h>
#include <retroforge/optimisation/design_space.h>

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
    OptimisationParameters optimisation;
    change(optimisation);
    try
    {
      optimisation.check();
      DesignSpace(parameters, varied, {20., 2., 0.}, optimisation);
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
  OptimisationParameters optimisation;
  optimisation.lower.emplace("billet/radius", 17.1);
  optimisation.upper.emplace("billet/radius", 23.3);
  optimisation.scales.emplace("billet/radius", 0.7);
  const std::vector<double> start = {20., 2., 0.};
  const DesignSpace         space(parameters, varied, start, optimisation);

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
  refuse("first step", [](auto &o) { o.first_step = 5.; });
}
