// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/optimization/design_space.h>
#include <retroforge/optimization/least_squares.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace retroforge
{
  namespace
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();

    bool is_among(const std::vector<std::string> &names, const std::string &name)
    {
      return std::find(names.begin(), names.end(), name) != names.end();
    }

    [[noreturn]] void refuse_held(const std::string &entry, const std::string &name)
    {
      throw Error("Optimisation/" + entry,
                  "'" + name + "' follows from the volume (Billet/volume held by), and is not varied",
                  "it may have bounds, but no scale and no relation",
                  "leave it out there, or hold the volume by another parameter");
    }

    /// @param scattered  the parameter that is, by design, not varied; or empty
    void check_names(const std::vector<std::string>       &known,
                     const OptimizationParameters::Values &values,
                     const std::string                    &entry,
                     const std::string                    &scattered)
    {
      for (const auto &[name, value] : values)
      {
        if (is_among(known, name))
          continue;
        if (name == scattered)
          throw Error("Optimisation/" + entry,
                      "'" + name + "' is scattered",
                      "it lies in Optimisation/scatter range, and the optimisation does not vary it",
                      "leave it out there");
        const auto first_mode = std::find_if(known.begin(), known.end(), [&](const std::string &of) {
          return of.rfind(name + " ", 0) == 0 && name.find("/free form") != std::string::npos;
        });
        if (first_mode != known.end())
          throw Error("Optimisation/" + entry,
                      "'" + name + "' stands for several modes",
                      "bounds and scales are those of one mode",
                      "name each, as '" + *first_mode + "'");
        const std::string near = nearest_name(name, known, 6);
        throw Error("Optimisation/" + entry,
                    "'" + name + "' is not a parameter of this optimisation",
                    "those are, by Design/parameters: " + join(known),
                    near.empty() ? "name some of these" : "did you mean '" + near + "'?");
      }
    }

    double
    value_or(const OptimizationParameters::Values &values, const std::string &name, const double otherwise)
    {
      const auto found = values.find(name);
      return found == values.end() ? otherwise : found->second;
    }
  } // namespace

  DesignSpace::DesignSpace(const std::vector<DesignParameter>   &parameters,
                           const std::vector<std::string>       &varied,
                           const std::vector<double>            &start,
                           const OptimizationParameters         &optimization,
                           const std::optional<DesignParameter> &held)
      : parameters_(parameters), start_(start)
  {
    if (varied.empty())
      throw Error("Design/parameters",
                  optimization.scattered.empty() ? "names no parameter"
                                                 : "names none but the one that is scattered",
                  "an optimisation varies one at least",
                  "name some that the scene offers");
    const std::string       &scattered   = optimization.scattered;
    std::vector<std::string> with_bounds = varied;
    if (held)
    {
      with_bounds.push_back(held->name);
      held_ = {held->name,
               held->unit,
               value_or(optimization.lower, held->name, -infinity),
               value_or(optimization.upper, held->name, infinity)};
      if (!(held_->lower < held_->upper))
        throw Error("Optimisation/upper bounds",
                    "bounds of " + held->name + " are " + as_text(held_->lower) + " and " +
                      as_text(held_->upper),
                    "the lower is less than the upper",
                    "leave a range between them");
      if (optimization.scales.count(held->name) > 0)
        refuse_held("scales", held->name);
      for (const std::string &relation : optimization.relations)
        if (relation.find(held->name) != std::string::npos &&
            std::none_of(varied.begin(), varied.end(), [&](const std::string &name) {
              return name.find(held->name) != std::string::npos && relation.find(name) != std::string::npos;
            }))
          refuse_held("relations", held->name);
    }
    check_names(with_bounds, optimization.lower, "lower bounds", scattered);
    check_names(with_bounds, optimization.upper, "upper bounds", scattered);
    check_names(varied, optimization.scales, "scales", scattered);
    constexpr double default_scale = 0.02;
    for (std::size_t j = 0; j < parameters.size(); ++j)
    {
      const DesignParameter &parameter = parameters[j];
      const std::string     &name      = parameter.name;
      scales_.push_back(value_or(optimization.scales, name, default_scale * std::abs(parameter.scale)));
      if (!is_among(varied, name))
      {
        lower_.push_back(start[j]);
        upper_.push_back(start[j]);
        continue;
      }
      // What must be positive stays away from zero, where no process is.
      const double least = parameter.is_free()    ? -infinity
                           : parameter.may_vanish ? 0.
                                                  : 1e-3 * std::abs(parameter.nominal);
      lower_.push_back(std::max(least, value_or(optimization.lower, name, -infinity)));
      upper_.push_back(std::min(parameter.largest, value_or(optimization.upper, name, infinity)));
      if (!(lower_[j] < upper_[j]))
        throw Error("Optimisation/upper bounds",
                    "bounds of " + name + " are " + as_text(lower_[j]) + " and " + as_text(upper_[j]),
                    "the lower is less than the upper",
                    "leave a range between them");
      if (start[j] < lower_[j] || start[j] > upper_[j])
        throw Error("Optimisation/" + std::string(start[j] < lower_[j] ? "lower" : "upper") + " bounds",
                    name + " begins at " + as_text(start[j]) + (parameter.unit.empty() ? "" : " ") +
                      parameter.unit + ", outside of " + as_text(lower_[j]) + " to " + as_text(upper_[j]),
                    "an optimisation begins within its bounds",
                    "widen them, or begin elsewhere with --at");
    }
    read_relations(optimization.relations, varied);
  }

  std::vector<double> DesignSpace::scaled(const std::vector<double> &mu) const
  {
    AssertDimension(mu.size(), size());
    std::vector<double> x(mu.size());
    for (std::size_t j = 0; j < mu.size(); ++j)
      x[j] = (mu[j] - start_[j]) / scales_[j];
    return x;
  }

  std::vector<double> DesignSpace::values(const std::vector<double> &x) const
  {
    AssertDimension(x.size(), size());
    std::vector<double> mu(x.size());
    for (std::size_t j = 0; j < x.size(); ++j)
      mu[j] = std::clamp(start_[j] + scales_[j] * x[j], lower_[j], upper_[j]);
    return mu;
  }

  std::vector<double> DesignSpace::pull_back(const std::vector<double> &by_mu) const
  {
    AssertDimension(by_mu.size(), size());
    std::vector<double> by_x(by_mu.size());
    for (std::size_t j = 0; j < by_mu.size(); ++j)
      by_x[j] = by_mu[j] * scales_[j];
    return by_x;
  }

  DesignSpace::At DesignSpace::at(const std::vector<double> &mu, const std::size_t j) const
  {
    AssertDimension(mu.size(), size());
    AssertIndexRange(j, size());
    constexpr double close = 1e-6; // in scales
    return lower_[j] == upper_[j]                    ? At::fixed
           : mu[j] - lower_[j] <= close * scales_[j] ? At::lower
           : upper_[j] - mu[j] <= close * scales_[j] ? At::upper
                                                     : At::inside;
  }

  bool DesignSpace::holds_as_equation(const std::vector<double> &mu, const std::size_t relation) const
  {
    AssertIndexRange(relation, scaled_relations_.size());
    constexpr double      close = 1e-6; // in scales
    const LinearRelation &of    = scaled_relations_[relation];
    const double          at    = of.value(scaled(mu));
    return of.is_equation() || at - of.lower <= close || of.upper - at <= close;
  }

  std::vector<double> DesignSpace::projected(std::vector<double> x) const
  {
    AssertDimension(x.size(), size());
    const std::vector<double> low = scaled_lower(), high = scaled_upper();
    const auto                onto_bounds = [&](std::vector<double> &y) {
      for (std::size_t j = 0; j < y.size(); ++j)
        y[j] = std::clamp(y[j], low[j], high[j]);
    };
    onto_bounds(x);
    if (relations_.empty())
      return x;
    // Dykstra's alternating projections: each set is left by what the last visit to it has moved.
    constexpr unsigned int           most_sweeps = 10000;
    constexpr double                 exact       = 1e-14;
    std::vector<std::vector<double>> left(relations_.size() + 1, std::vector<double>(x.size(), 0.));
    const auto                       visit = [&](const std::size_t set, const auto &onto) {
      std::vector<double> y = x;
      for (std::size_t j = 0; j < x.size(); ++j)
        y[j] += left[set][j];
      const std::vector<double> before = y;
      onto(y);
      double moved = 0.;
      for (std::size_t j = 0; j < x.size(); ++j)
      {
        const double leaves = before[j] - y[j];
        moved               = std::max(moved, std::abs(leaves - left[set][j]));
        left[set][j]        = leaves;
      }
      x = y;
      return moved;
    };
    for (unsigned int sweep = 0; sweep < most_sweeps; ++sweep)
    {
      double moved = 0.;
      for (std::size_t r = 0; r < relations_.size(); ++r)
        moved = std::max(moved, visit(r, [&](std::vector<double> &y) {
                           const LinearRelation &of = scaled_relations_[r];
                           const double          at = of.value(y), to = std::clamp(at, of.lower, of.upper);
                           for (std::size_t j = 0; j < y.size(); ++j)
                             y[j] += (to - at) * of.weights[j];
                         }));
      moved = std::max(moved, visit(relations_.size(), onto_bounds));
      if (moved <= exact)
        break;
    }
    return x;
  }

  std::vector<std::vector<double>> DesignSpace::free_directions(const std::vector<double> &mu) const
  {
    std::vector<std::vector<double>> held, free;
    const auto                       add_what_is_new = [](std::vector<double>                     direction,
                                    const std::vector<std::vector<double>> &known,
                                    std::vector<std::vector<double>>       &to) {
      // Twice, for rounding.
      for (unsigned int pass = 0; pass < 2; ++pass)
        for (const auto *basis : {&known, const_cast<const std::vector<std::vector<double>> *>(&to)})
          for (const std::vector<double> &unit : *basis)
          {
            const double along = std::inner_product(unit.begin(), unit.end(), direction.begin(), 0.);
            for (std::size_t j = 0; j < direction.size(); ++j)
              direction[j] -= along * unit[j];
          }
      const double length =
        std::sqrt(std::inner_product(direction.begin(), direction.end(), direction.begin(), 0.));
      constexpr double new_enough = 1e-8;
      if (length < new_enough)
        return;
      for (double &entry : direction)
        entry /= length;
      to.push_back(std::move(direction));
    };
    std::vector<std::vector<double>> units(mu.size(), std::vector<double>(mu.size(), 0.));
    for (std::size_t j = 0; j < mu.size(); ++j)
    {
      units[j][j] = 1.;
      if (at(mu, j) != At::inside)
        held.push_back(units[j]);
    }
    for (std::size_t r = 0; r < relations_.size(); ++r)
      if (holds_as_equation(mu, r))
        add_what_is_new(scaled_relations_[r].weights, {}, held);
    for (std::size_t j = 0; j < mu.size(); ++j)
      if (at(mu, j) == At::inside)
        add_what_is_new(units[j], held, free);
    return free;
  }

  double DesignSpace::projected_length(const std::vector<double> &mu, const std::vector<double> &by_mu) const
  {
    const std::vector<double> x = scaled(mu), g = pull_back(by_mu);
    std::vector<double>       y = x;
    for (std::size_t j = 0; j < x.size(); ++j)
      y[j] -= g[j];
    y          = projected(y);
    double sum = 0.;
    for (std::size_t j = 0; j < x.size(); ++j)
      sum += (y[j] - x[j]) * (y[j] - x[j]);
    return std::sqrt(sum);
  }

  void DesignSpace::read_relations(const std::vector<std::string> &texts,
                                   const std::vector<std::string> &varied)
  {
    for (const std::string &text : texts)
    {
      const LinearRelation by_varied = read_relation(text, varied);
      LinearRelation       relation{
        by_varied.text, std::vector<double>(size(), 0.), by_varied.lower, by_varied.upper};
      for (std::size_t j = 0; j < size(); ++j)
        for (std::size_t k = 0; k < varied.size(); ++k)
          if (parameters_[j].name == varied[k])
            relation.weights[j] = by_varied.weights[k];
      LinearRelation of_x   = relation;
      double         square = 0.;
      for (std::size_t j = 0; j < size(); ++j)
      {
        of_x.weights[j] *= scales_[j];
        square += of_x.weights[j] * of_x.weights[j];
      }
      const double length = std::sqrt(square), at_start = relation.value(start_);
      for (double &weight : of_x.weights)
        weight /= length;
      of_x.lower             = (relation.lower - at_start) / length;
      of_x.upper             = (relation.upper - at_start) / length;
      constexpr double exact = 1e-9; // in scales
      if (relation.excess(start_) > exact * length)
        throw Error("Optimisation/relations",
                    "'" + relation.text + "' does not hold at the start, by " +
                      as_text(relation.excess(start_)),
                    "an optimisation begins where its relations hold",
                    "change it, or begin elsewhere with --at");
      relations_.push_back(std::move(relation));
      scaled_relations_.push_back(std::move(of_x));
    }
  }

  std::vector<double> slopes_of_relations(const DesignSpace         &space,
                                          const std::vector<double> &mu,
                                          const std::vector<double> &by_mu)
  {
    std::vector<double>       slopes(space.relations().size(), 0.);
    std::vector<unsigned int> active, free;
    for (unsigned int r = 0; r < slopes.size(); ++r)
      if (space.holds_as_equation(mu, r))
        active.push_back(r);
    for (unsigned int j = 0; j < space.size(); ++j)
      if (space.at(mu, j) == DesignSpace::At::inside)
        free.push_back(j);
    // In scaled variables, where changes are alike.
    std::vector<std::vector<double>> weights(active.size());
    std::vector<double>              g;
    for (const unsigned int j : free)
    {
      g.push_back(by_mu[j] * space.scales()[j]);
      for (unsigned int r = 0; r < active.size(); ++r)
        weights[r].push_back(space.relations()[active[r]].weights[j] * space.scales()[j]);
    }
    const std::vector<double> nu = least_squares(weights, g);
    for (unsigned int r = 0; r < active.size(); ++r)
      slopes[active[r]] = nu[r];
    return slopes;
  }
} // namespace retroforge
