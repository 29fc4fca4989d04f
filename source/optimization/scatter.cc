// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/optimization/scatter.h>

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  Scatter::Scatter(const std::vector<DesignParameter> &parameters,
                   const OptimizationParameters       &optimization,
                   std::vector<bool>                   from_below)
      : name_(optimization.scattered)
      , from_below_(std::move(from_below))
      , deviations_(optimization.deviations)
  {
    if (name_.empty())
      return;
    std::vector<std::string> known;
    for (const DesignParameter &parameter : parameters)
      known.push_back(parameter.name);
    parameter_ = std::find(known.begin(), known.end(), name_) - known.begin();
    if (parameter_ == known.size())
      throw Error("Optimisation/scattered",
                  "'" + name_ + "' is not among the parameters of the design",
                  "those are, by Design/parameters: " + join(known),
                  "add it there");
    const DesignParameter &scattered = parameters[parameter_];
    for (const double end : optimization.scatter_range)
      if (!scattered.is_free() && !(end > 0. || (end == 0. && scattered.may_vanish)))
        throw Error("Optimisation/scatter range",
                    "has " + as_text(end) + " " + scattered.unit + " for " + name_,
                    scattered.may_vanish ? "it is not negative" : "it is positive",
                    "let the range lie where it may be");
    const dealii::QGauss<1> quadrature(optimization.samples);
    const double            from = optimization.scatter_range[0], to = optimization.scatter_range[1];
    for (unsigned int q = 0; q < quadrature.size(); ++q)
    {
      values_.push_back(from + (to - from) * quadrature.point(q)(0));
      weights_.push_back(quadrature.weight(q));
    }
  }

  std::string Scatter::in_words() const
  {
    return empty()
             ? ""
             : "mean + " + as_text(deviations_) + " standard deviation(s) (under a lower limit: -) over " +
                 std::to_string(n_samples()) + " values of " + name_;
  }

  std::vector<double> Scatter::sample(std::vector<double> mu, const std::size_t i) const
  {
    AssertIndexRange(i, n_samples());
    if (!empty())
      mu[parameter_] = values_[i];
    return mu;
  }

  Evaluation Scatter::combined(const std::vector<double> &mu, const std::vector<Evaluation> &samples) const
  {
    Assert(samples.size() == n_samples() ||
             (!samples.empty() && samples.size() < n_samples() && samples.back().failed()),
           dealii::ExcMessage("there is a forging for each value, up to one that fails"));
    if (empty())
      return samples.front();
    Evaluation all;
    all.mu = mu;
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
      all.seconds += samples[i].seconds;
      all.increments = samples[i].increments;
      if (samples[i].failed())
      {
        all.failure = "with " + name_ + " = " + as_text(values_[i]) + ": " + samples[i].failure;
        return all;
      }
    }
    combine_values(samples, all);
    combine_gradients(samples, all);
    return all;
  }

  namespace
  {
    /// Mean and standard deviation of one objective, which rounding leaves alone where it is the same in all.
    std::pair<double, double>
    moments(const std::vector<Evaluation> &samples, const std::vector<double> &weights, const std::size_t o)
    {
      const double first = samples.front().values[o];
      if (std::all_of(
            samples.begin(), samples.end(), [&](const Evaluation &of) { return of.values[o] == first; }))
        return {first, 0.};
      double mean = 0., variance = 0.;
      for (std::size_t i = 0; i < samples.size(); ++i)
        mean += weights[i] * samples[i].values[o];
      for (std::size_t i = 0; i < samples.size(); ++i)
        variance += weights[i] * std::pow(samples[i].values[o] - mean, 2);
      return {mean, std::sqrt(variance)};
    }
  } // namespace

  void Scatter::combine_values(const std::vector<Evaluation> &samples, Evaluation &all) const
  {
    for (std::size_t o = 0; o < samples.front().values.size(); ++o)
    {
      const auto [mean, sigma] = moments(samples, weights_, o);
      all.values.push_back(mean + (from_below_[o] ? -deviations_ : deviations_) * sigma);
    }
  }

  void Scatter::combine_gradients(const std::vector<Evaluation> &samples, Evaluation &all) const
  {
    if (std::any_of(samples.begin(), samples.end(), [](const Evaluation &e) { return e.gradients.empty(); }))
      return;
    for (std::size_t o = 0; o < all.values.size(); ++o)
    {
      const auto [mean, sigma] = moments(samples, weights_, o);
      const double        sign = from_below_[o] ? -deviations_ : deviations_;
      std::vector<double> gradient(all.mu.size(), 0.);
      for (std::size_t i = 0; i < samples.size(); ++i)
      {
        // d(sigma)/d(value_i) = w_i (value_i - mean) / sigma
        const double weight =
          weights_[i] * (1. + (sigma > 0. ? sign * (samples[i].values[o] - mean) / sigma : 0.));
        for (std::size_t j = 0; j < gradient.size(); ++j)
          gradient[j] += weight * samples[i].gradients[o][j];
      }
      all.gradients.push_back(std::move(gradient));
    }
  }
} // namespace retroforge
