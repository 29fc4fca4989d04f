// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include "../element/element_test_tools.h"
#include <retroforge/core/error.h>

namespace retroforge
{
  /// A named part of what an objective depends on: pointers to its numbers.
  template <typename Number>
  using Group = std::pair<std::string, std::vector<Number *>>;

  template <typename Number>
  void append(NodalVectors<Number> &vectors, std::vector<Number *> &entries)
  {
    for (auto &v : vectors)
      for (unsigned int i = 0; i < 3; ++i)
        entries.push_back(&v[i]);
  }

  /// Compares the reverse of a scalar with its dual numbers, for each group of inputs alone and for all, and
  /// the values along the line with the Taylor expansion. Prints on which groups the scalar depends.
  /// @param Inputs    a template of the number type with groups()
  /// @param evaluate  for Inputs of either type
  /// @param reverse   returns Inputs<double>, the derivatives
  template <template <typename> class Inputs, typename Evaluate, typename Reverse>
  double check_derivatives(const std::string    &name,
                           const Inputs<double> &at,
                           const Evaluate       &evaluate,
                           const Reverse        &reverse,
                           const Inputs<Dual>   &dual_shape,
                           Random               &random)
  {
    Inputs<double>                   x = at, bar = reverse(at);
    Inputs<Dual>                     dual   = dual_shape;
    const auto                       groups = x.groups(), bar_groups = bar.groups();
    const auto                       dual_groups = dual.groups();
    double                           total = 0., worst = 0.;
    std::string                      depends;
    std::vector<std::vector<double>> directions;
    const double                     start = evaluate(at);
    for (std::size_t g = 0; g < groups.size(); ++g)
    {
      directions.emplace_back();
      for (std::size_t i = 0; i < groups[g].second.size(); ++i)
      {
        directions.back().push_back(random.scalar() * (1e-3 + std::abs(*groups[g].second[i])));
        *dual_groups[g].second[i] = Dual(*groups[g].second[i]);
      }
    }
    for (std::size_t g = 0; g < groups.size(); ++g)
    {
      double product = 0., absolute = 0.;
      for (std::size_t i = 0; i < directions[g].size(); ++i)
      {
        dual_groups[g].second[i]->fastAccessDx(0) = directions[g][i];
        product += directions[g][i] * *bar_groups[g].second[i];
        absolute += std::abs(directions[g][i] * *bar_groups[g].second[i]);
      }
      const double derivative = evaluate(dual).dx(0);
      for (Dual *entry : dual_groups[g].second)
        entry->fastAccessDx(0) = 0.;
      // Directions are of the size of the inputs: what is small against the value is rounding.
      const double error = std::abs(derivative - product) / (absolute + 1e-3 * std::abs(start));
      worst              = error < 1e300 ? std::max(worst, error) : 1e300; // NaN counts as wrong
      if (std::abs(derivative) > 1e-12 * std::abs(start))
        depends += " " + groups[g].first;
      total += product;
    }
    // Taylor: all inputs along the line at once.
    std::vector<double> remainders;
    for (const double step : {4e-5, 2e-5, 1e-5, 5e-6})
    {
      Inputs<double> moved        = at;
      const auto     moved_groups = moved.groups();
      for (std::size_t g = 0; g < groups.size(); ++g)
        for (std::size_t i = 0; i < directions[g].size(); ++i)
          *moved_groups[g].second[i] += step * directions[g][i];
      remainders.push_back(std::abs(evaluate(moved) - start - step * total));
    }
    // The order is that of vanishing steps: of a wrong slope the remainder shows most at the smallest ones.
    const bool quadratic =
      remainders[3] < 1e-13 * std::abs(start) || std::log2(remainders[2] / remainders[3]) > 1.95;
    std::cout << name << ": dot product < 1e-12: "
              << (worst < 1e-12 ? "yes" : "NO, " + std::to_string(worst * 1e12) + "e-12")
              << ", Taylor order > 1.95: " << (quadratic ? "yes" : "NO") << ", depends on" << depends
              << std::endl;
    if (!quadratic)
      for (const double r : remainders)
        std::cout << "  remainder " << r << " of " << start << std::endl;
    return worst;
  }

  /// What an action throws.
  template <typename Action>
  void refused(const Action &action)
  {
    try
    {
      action();
      std::cout << "  NOT refused" << std::endl;
    }
    catch (const Error &error)
    {
      std::cout << "  " << error.what() << std::endl;
    }
  }
} // namespace retroforge
