// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/optimisation/design_space.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();

    bool is_among(const std::vector<std::string> &names, const std::string &name)
    {
      return std::find(names.begin(), names.end(), name) != names.end();
    }

    void check_names(const std::vector<std::string>       &known,
                     const OptimisationParameters::Values &values,
                     const std::string                    &entry)
    {
      for (const auto &[name, value] : values)
        if (!is_among(known, name))
        {
          const std::string near = nearest_name(name, known, 6);
          throw Error("Optimisation/" + entry,
                      "'" + name + "' is not a parameter of this optimisation",
                      "those are, by Design/parameters: " + join(known),
                      near.empty() ? "name some of these" : "did you mean '" + near + "'?");
        }
    }

    double
    value_or(const OptimisationParameters::Values &values, const std::string &name, const double otherwise)
    {
      const auto found = values.find(name);
      return found == values.end() ? otherwise : found->second;
    }
  } // namespace

  DesignSpace::DesignSpace(const std::vector<DesignParameter> &parameters,
                           const std::vector<std::string>     &varied,
                           const std::vector<double>          &start,
                           const OptimisationParameters       &optimisation)
      : parameters_(parameters), start_(start)
  {
    if (varied.empty())
      throw Error("Design/parameters",
                  "names no parameter",
                  "an optimisation varies one at least",
                  "name some that the scene offers");
    check_names(varied, optimisation.lower, "lower bounds");
    check_names(varied, optimisation.upper, "upper bounds");
    check_names(varied, optimisation.scales, "scales");
    constexpr double default_scale = 0.02;
    for (std::size_t j = 0; j < parameters.size(); ++j)
    {
      const DesignParameter &parameter = parameters[j];
      const std::string     &name      = parameter.name;
      scales_.push_back(value_or(optimisation.scales, name, default_scale * std::abs(parameter.scale)));
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
      lower_.push_back(std::max(least, value_or(optimisation.lower, name, -infinity)));
      upper_.push_back(std::min(parameter.largest, value_or(optimisation.upper, name, infinity)));
      if (!(lower_[j] < upper_[j]))
        throw Error("Optimisation/upper bounds",
                    "bounds of " + name + " are " + as_text(lower_[j]) + " and " + as_text(upper_[j]),
                    "the lower is less than the upper",
                    "leave a range between them");
      if (start[j] < lower_[j] || start[j] > upper_[j])
        throw Error("Optimisation/" + std::string(start[j] < lower_[j] ? "lower" : "upper") + " bounds",
                    name + " begins at " + as_text(start[j]) + " " + parameter.unit + ", outside of " +
                      as_text(lower_[j]) + " to " + as_text(upper_[j]),
                    "an optimisation begins within its bounds",
                    "widen them, or begin elsewhere with --at");
    }
  }

  std::vector<double> DesignSpace::scaled(const std::vector<double> &mu) const
  {
    std::vector<double> x(mu.size());
    for (std::size_t j = 0; j < mu.size(); ++j)
      x[j] = (mu[j] - start_[j]) / scales_[j];
    return x;
  }

  std::vector<double> DesignSpace::values(const std::vector<double> &x) const
  {
    std::vector<double> mu(x.size());
    for (std::size_t j = 0; j < x.size(); ++j)
      mu[j] = std::clamp(start_[j] + scales_[j] * x[j], lower_[j], upper_[j]);
    return mu;
  }

  std::vector<double> DesignSpace::pull_back(const std::vector<double> &by_mu) const
  {
    std::vector<double> by_x(by_mu.size());
    for (std::size_t j = 0; j < by_mu.size(); ++j)
      by_x[j] = by_mu[j] * scales_[j];
    return by_x;
  }

  DesignSpace::At DesignSpace::at(const std::vector<double> &mu, const std::size_t j) const
  {
    constexpr double close = 1e-6; // in scales
    return lower_[j] == upper_[j]                    ? At::fixed
           : mu[j] - lower_[j] <= close * scales_[j] ? At::lower
           : upper_[j] - mu[j] <= close * scales_[j] ? At::upper
                                                     : At::inside;
  }

  double DesignSpace::projected_length(const std::vector<double> &mu, const std::vector<double> &by_mu) const
  {
    const std::vector<double> x = scaled(mu), g = pull_back(by_mu), low = scaled_lower(),
                              high = scaled_upper();
    double sum                     = 0.;
    for (std::size_t j = 0; j < x.size(); ++j)
    {
      const double step = std::clamp(x[j] - g[j], low[j], high[j]) - x[j];
      sum += step * step;
    }
    return std::sqrt(sum);
  }
} // namespace retroforge
