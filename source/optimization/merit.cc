// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/core/text.h>
#include <retroforge/optimization/least_squares.h>
#include <retroforge/optimization/merit.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    unsigned int index_of(const Objectives &objectives, const std::string &name, const std::string &entry)
    {
      std::vector<std::string> known;
      for (unsigned int o = 0; o < objectives.size(); ++o)
      {
        if (objectives[o].name == name)
          return o;
        known.push_back(objectives[o].name);
      }
      const std::string near = nearest_name(name, known, tolerated_edits(name));
      throw Error("Optimisation/" + entry,
                  "'" + name + "' is not an objective of this case",
                  "those are, by Objectives/names: " + join(known),
                  near.empty() ? "name some of these, or add it there" : "did you mean '" + near + "'?");
    }
  } // namespace

  Criteria::Criteria(const Objectives &objectives, const OptimizationParameters &parameters)
  {
    std::vector<bool> is_limited(objectives.size(), false);
    const auto        add = [&](const OptimizationParameters::Values &values, const bool at_least) {
      for (const auto &[name, bound] : values)
      {
        const unsigned int o = index_of(objectives, name, at_least ? "at least" : "at most");
        if (!at_least && bound < objectives[o].least)
          throw Error("Optimisation/at most",
                      "asks for at most " + as_text(bound) + " of '" + name + "'",
                      "no value of it is below " + as_text(objectives[o].least),
                      "give a bound above that, in " + objectives[o].unit());
        limits.push_back({o, bound, at_least});
        is_limited[o] = true;
      }
    };
    add(parameters.at_most, false);
    add(parameters.at_least, true);
    objective.weights.assign(objectives.size(), 0.);
    for (const auto &[name, measured] : parameters.data)
      data.push_back(
        {index_of(objectives, name, "data"), measured, parameters.uncertainties.find(name)->second});
    if (!data.empty())
    {
      objective.name = "misfit";
      return;
    }
    std::vector<std::string> names = parameters.objective;
    if (names.empty())
      for (std::size_t o = 0; o < objectives.size(); ++o)
        if (!is_limited[o])
          names.push_back(objectives[o].name);
    for (const std::string &name : names)
    {
      const unsigned int o = index_of(objectives, name, "objective");
      objective.weights[o] = objectives[o].weight;
      objective.name += (objective.name.empty() ? "" : " + ") + name;
      const std::string unit = objectives[o].unit();
      objective.unit         = name == names.front() || objective.unit == unit ? unit : "mixed";
    }
    if (std::all_of(objective.weights.begin(), objective.weights.end(), [](double w) { return w == 0.; }))
      throw Error("Optimisation/objective",
                  names.empty() ? "leaves nothing to be made small: all objectives have limits"
                                : "names objectives whose weights are all 0",
                  "an optimisation makes one objective or a weighted sum small",
                  "name one there, with a weight, and add it to Objectives/names");
    for (Limit &limit : limits)
      limit.size = std::abs(limit.bound);
  }

  void Criteria::add_value(const double least, const double most)
  {
    const auto place = static_cast<unsigned int>(objective.weights.size());
    objective.weights.push_back(0.);
    if (std::isfinite(least))
      limits.push_back({place, least, true, std::abs(least)});
    if (std::isfinite(most))
      limits.push_back({place, most, false, std::abs(most)});
  }

  void Criteria::set_sizes(const std::vector<double> &start)
  {
    for (Limit &limit : limits)
      if (limit.bound == 0.)
        limit.size = start[limit.objective] == 0. ? 1. : std::abs(start[limit.objective]);
  }

  double Criteria::value(const std::vector<double> &values) const
  {
    AssertDimension(values.size(), objective.weights.size());
    double sum = objective(values);
    for (const Datum &datum : data)
      sum += 0.5 * std::pow(datum.misfit(values), 2);
    return sum;
  }

  std::vector<double> Criteria::slopes(const std::vector<double> &values) const
  {
    AssertDimension(values.size(), objective.weights.size());
    std::vector<double> slopes = objective.weights;
    for (const Datum &datum : data)
      slopes[datum.objective] += datum.misfit(values) / datum.deviation;
    return slopes;
  }

  bool Criteria::uses(const unsigned int o) const
  {
    const auto is_of = [o](const auto &criterion) { return criterion.objective == o; };
    return std::any_of(limits.begin(), limits.end(), is_of) || std::any_of(data.begin(), data.end(), is_of);
  }

  double Criteria::largest_excess(const std::vector<double> &values) const
  {
    double largest = 0.;
    for (const Limit &limit : limits)
      largest = std::max(largest, limit.excess(values));
    return largest;
  }

  double Merit::pressed(const std::size_t limit, const std::vector<double> &values) const
  {
    return std::max(multipliers[limit] + penalties[limit] * criteria->limits[limit].excess(values), 0.);
  }

  double Merit::term(const std::size_t limit, const double excess) const
  {
    const double rho = penalties[limit], lambda = multipliers[limit];
    const double pressed = std::max(lambda + rho * excess, 0.);
    return (pressed * pressed - lambda * lambda) / (2. * rho);
  }

  double Merit::value(const std::vector<double> &values) const
  {
    double merit = (criteria->value(values) - origin) / size;
    for (std::size_t i = 0; i < multipliers.size(); ++i)
      merit += term(i, criteria->limits[i].excess(values));
    return merit;
  }

  std::vector<double> Merit::gradient(const std::vector<double>              &values,
                                      const std::vector<std::vector<double>> &gradients) const
  {
    AssertDimension(gradients.size(), values.size());
    Assert(!gradients.empty(), dealii::ExcMessage("a merit is of at least one objective"));
    std::vector<double> by_objective = criteria->slopes(values);
    for (double &weight : by_objective)
      weight /= size;
    for (std::size_t i = 0; i < multipliers.size(); ++i)
    {
      const Limit &limit = criteria->limits[i];
      by_objective[limit.objective] += pressed(i, values) * limit.slope();
    }
    std::vector<double> sum(gradients.front().size(), 0.);
    for (std::size_t o = 0; o < by_objective.size(); ++o)
      for (std::size_t j = 0; j < sum.size(); ++j)
        sum[j] += by_objective[o] * gradients[o][j];
    return sum;
  }

  std::vector<double> least_squares_multipliers(const std::vector<double>              &g,
                                                const std::vector<std::vector<double>> &columns)
  {
    std::vector<double>       lambda(columns.size(), 0.);
    std::vector<unsigned int> used(columns.size());
    for (unsigned int i = 0; i < used.size(); ++i)
      used[i] = i;
    // There are few limits: the most negative multiplier is left out until none is.
    std::vector<double> minus_g(g);
    for (double &entry : minus_g)
      entry = -entry;
    while (!used.empty())
    {
      std::vector<std::vector<double>> of_used;
      for (const unsigned int i : used)
        of_used.push_back(columns[i]);
      const std::vector<double> solution = least_squares(of_used, minus_g);
      const auto                least    = std::min_element(solution.begin(), solution.end());
      if (*least >= 0.)
      {
        for (unsigned int i = 0; i < used.size(); ++i)
          lambda[used[i]] = solution[i];
        break;
      }
      used.erase(used.begin() + (least - solution.begin()));
    }
    return lambda;
  }
} // namespace retroforge
