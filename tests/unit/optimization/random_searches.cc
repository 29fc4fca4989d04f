// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Searches among random convex functions of two to five variables, between bounds, with no, one or two limits, and
// with noise in values and gradients, as forgings have it: how many designs they take, how much of what could be
// gained they leave, by how much they exceed limits, and how many end without settling them. The exact optima are
// found by the same search, without noise and to the end.

#include <retroforge/objective/energy.h>
#include <retroforge/optimization/search.h>
#include <retroforge/optimization/small_vectors.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iostream>
#include <limits>
#include <random>

using namespace retroforge;

namespace
{
  using Vector = std::vector<double>;

  const char *answer(const bool yes)
  {
    return yes ? "yes" : "NO";
  }

  /// -1 to 1, by all bits of a point: another one at the nearest point, the same one at the same.
  double rough(const Vector &x, const unsigned int k)
  {
    std::uint64_t hash = 1469598103934665603ull ^ (k * 0x9E3779B97F4A7C15ull);
    for (const double entry : x)
    {
      std::uint64_t bits;
      std::memcpy(&bits, &entry, sizeof bits);
      hash = (hash ^ bits) * 1099511628211ull;
      hash = (hash ^ (hash >> 29)) * 0xBF58476D1CE4E5B9ull;
      hash ^= hash >> 32;
    }
    return static_cast<double>(hash >> 11) / 4503599627370496. - 1.;
  }

  /// Uniform and normal numbers that are the same everywhere.
  class Random
  {
  public:
    explicit Random(const unsigned int seed) : generator_(seed) {}

    double uniform() { return 2. * (generator_() + 0.5) / 4294967296. - 1.; } ///< -1 to 1
    double normal()
    {
      const double radius = std::sqrt(-2. * std::log(0.5 * (uniform() + 1.)));
      return radius * std::cos(3.141592653589793 * uniform());
    }
    Vector normals(const unsigned int n)
    {
      Vector v(n);
      for (double &entry : v)
        entry = normal();
      return v;
    }

  private:
    std::mt19937 generator_;
  };

  /// g.d + d.H d / 2 + sum_j b d_j^4 / (12 (1 + d_j^2)),  d = x - centre.
  struct Function
  {
    Vector              centre, g;
    std::vector<Vector> hessian;
    double              bend = 0.;

    double value(const Vector &x) const
    {
      const Vector d   = difference(x, centre);
      double       sum = dot(g, d);
      for (std::size_t i = 0; i < d.size(); ++i)
        sum += 0.5 * d[i] * dot(hessian[i], d) + bend * std::pow(d[i], 4) / (12. * (1. + d[i] * d[i]));
      return sum;
    }

    Vector gradient(const Vector &x) const
    {
      const Vector d   = difference(x, centre);
      Vector       sum = g;
      for (std::size_t i = 0; i < d.size(); ++i)
      {
        const double s = d[i] * d[i];
        sum[i] += dot(hessian[i], d) + bend * d[i] * s * (4. + 2. * s) / (12. * (1. + s) * (1. + s));
      }
      return sum;
    }
  };

  /// Eigenvalues evenly spread by their logarithm, in random directions.
  std::vector<Vector>
  random_hessian(Random &random, const unsigned int n, const double least, const double most)
  {
    std::vector<Vector> directions, hessian(n, Vector(n, 0.));
    for (unsigned int k = 0; k < n; ++k)
    {
      Vector direction = random.normals(n);
      for (const Vector &other : directions)
        add(-dot(other, direction), other, direction);
      const double size = length(direction);
      for (double &entry : direction)
        entry /= size;
      const double eigenvalue = least * std::pow(most / least, 0.5 * (random.uniform() + 1.));
      for (unsigned int i = 0; i < n; ++i)
        add(eigenvalue * direction[i], direction, hessian[i]);
      directions.push_back(direction);
    }
    return hessian;
  }

  struct Problem
  {
    std::vector<Function> functions; ///< the objective, and limits
    Vector                lower, upper, start, bounds, offsets, noise, noise_of_gradients;

    Problem(const unsigned int seed, const unsigned int n, const unsigned int n_limits, const double part)
        : lower(n, -1e3), upper(n, 1e3), start(n, 0.)
    {
      Random       random(seed);
      Function     objective{random.normals(n), Vector(n, 0.), random_hessian(random, n, 0.03, 3.), 0.5};
      const double far  = 3. * std::pow(2., random.uniform());
      const double size = length(objective.centre);
      for (double &entry : objective.centre)
        entry *= far / size;
      // Bounds on some, on the way to where it is least.
      for (unsigned int j = 0; j < n; ++j)
        if (random.uniform() > 0.)
        {
          const double bound                 = 0.5 * objective.centre[j] * (1. + random.uniform());
          (bound > 0. ? upper[j] : lower[j]) = bound;
        }
      functions.push_back(objective);
      for (unsigned int i = 0; i < n_limits; ++i)
      {
        Function limit{start, random.normals(n), random_hessian(random, n, 0.01, 0.3)};
        if (i == 0)
          for (unsigned int j = 0; j < n; ++j)
            limit.g[j] = 0.7 * limit.g[j] + objective.centre[j] / far;
        const double slope = length(limit.g);
        for (double &entry : limit.g)
          entry /= slope;
        functions.push_back(limit);
        // One is relative to 100, as temperatures are; some are exceeded at the start.
        offsets.push_back(i == 0 ? 100. : 5.);
        const double bound = 0.25 * far * (1. + random.uniform());
        bounds.push_back(random.uniform() > 0.6 ? -0.3 : bound);
      }
      noise              = {part * objective.value(start)};
      noise_of_gradients = {3. * part * length(objective.gradient(start))};
      noise.resize(1 + n_limits, part);
      noise_of_gradients.resize(1 + n_limits, 3. * part);
    }

    double excess(const Vector &x) const
    {
      double largest = 0.;
      for (std::size_t i = 0; i < bounds.size(); ++i)
        largest = std::max(largest, functions[i + 1].value(x) - bounds[i]);
      return largest;
    }
  };

  struct End
  {
    Vector      x;
    std::size_t n_designs;
    bool        settled;
  };

  End search(const Problem &problem, const bool is_rough)
  {
    OptimizationParameters parameters;
    parameters.objective          = {"f"};
    parameters.iterations         = is_rough ? 60 : 3000;
    parameters.simulations        = 100000;
    parameters.gradient_tolerance = is_rough ? 1e-3 : 1e-8;
    parameters.least_gain         = is_rough ? parameters.least_gain : 0.;
    parameters.limit_tolerance    = is_rough ? 1e-4 : 1e-7;
    std::vector<DesignParameter> all;
    std::vector<std::string>     varied;
    for (std::size_t j = 0; j < problem.start.size(); ++j)
    {
      varied.push_back(std::string(1, static_cast<char>('a' + j)));
      all.push_back({varied.back(), "mm", DesignParameter::Kind::billet, 1., 1.});
      parameters.scales.emplace(varied.back(), 1.);
      parameters.lower.emplace(varied.back(), problem.lower[j]);
      parameters.upper.emplace(varied.back(), problem.upper[j]);
    }
    const std::vector<std::string> names = {"f", "g", "h"};
    Objectives                     objectives(problem.functions.size());
    for (std::size_t o = 0; o < objectives.size(); ++o)
    {
      objectives[o].name  = names[o];
      objectives[o].path  = std::make_unique<EnergyObjective>();
      objectives[o].least = -std::numeric_limits<double>::infinity();
      if (o > 0)
        parameters.at_most.emplace(names[o], problem.offsets[o - 1]);
    }
    const DesignSpace space(all, varied, problem.start, parameters);
    Criteria          criteria(objectives, parameters);
    const auto        evaluate = [&](const Vector &x, const bool with_gradients) {
      Evaluation evaluation;
      evaluation.mu = x;
      for (unsigned int o = 0; o < problem.functions.size(); ++o)
      {
        const double shift = o == 0 ? 0. : problem.offsets[o - 1] - problem.bounds[o - 1];
        evaluation.values.push_back(problem.functions[o].value(x) + shift +
                                    (is_rough ? problem.noise[o] * rough(x, o) : 0.));
        if (!with_gradients)
          continue;
        Vector gradient = problem.functions[o].gradient(x);
        for (unsigned int j = 0; is_rough && j < gradient.size(); ++j)
          gradient[j] += problem.noise_of_gradients[o] * rough(x, 100 + 10 * o + j);
        evaluation.gradients.push_back(gradient);
      }
      return evaluation;
    };
    std::vector<Vector>     evaluated;
    std::vector<Evaluation> accepted;
    SearchTask              task;
    task.evaluate = [&](const Vector &x) {
      if (std::find(evaluated.begin(), evaluated.end(), x) == evaluated.end())
        evaluated.push_back(x);
      return evaluate(x, false);
    };
    task.differentiate = [&](const Vector &x) { return evaluate(x, true); };
    task.n_evaluated   = [&] { return evaluated.size(); };
    task.decided       = [&](const Evaluation &evaluation, const bool is_accepted) {
      if (is_accepted)
        accepted.push_back(evaluation);
    };
    task.renewed = [](double) {};
    task.evaluate(problem.start);
    const Evaluation start = task.differentiate(problem.start);
    criteria.set_sizes(start.values);
    Search searching(space, criteria, parameters, task);
    searching.begin(start);
    searching.set_noise(is_rough ? problem.noise[0] : 0.);
    const bool settled = searching.run();
    Evaluation best    = searching.now();
    // As `optimize` does.
    const auto excess = [&](const Evaluation &evaluation) {
      return std::max(parameters.limit_tolerance, criteria.largest_excess(evaluation.values));
    };
    for (const Evaluation &other : accepted)
      if (!settled && (excess(other) < excess(best) ||
                       (excess(other) == excess(best) && other.values[0] < best.values[0])))
        best = other;
    return {best.mu, evaluated.size(), settled || problem.bounds.empty()};
  }

  double quantile(Vector values, const double part)
  {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
  }
} // namespace

int main(const int argc, char **)
{
  const bool tells = argc > 1; // the figures
  for (const double part : {0.003, 0.03})
  {
    Vector       designs, left, excess;
    unsigned int n_unsettled = 0, n_without = 0;
    for (const unsigned int n_limits : {0, 1, 2})
      for (const unsigned int n : {2, 3, 5})
        for (unsigned int k = 0; k < 40; ++k)
        {
          const Problem problem(1000 * n + 100000 * n_limits + k, n, n_limits, part);
          const End     exact = search(problem, false);
          if (!exact.settled) // its limits exclude each other
          {
            ++n_without;
            continue;
          }
          const End    end     = search(problem, true);
          const auto  &f       = problem.functions[0];
          const double from    = f.value(problem.start);
          const double to_gain = std::max(std::abs(from - f.value(exact.x)), 0.2 * from);
          designs.push_back(static_cast<double>(end.n_designs));
          left.push_back(std::abs(f.value(end.x) - f.value(exact.x)) / to_gain);
          excess.push_back(problem.excess(end.x));
          n_unsettled += end.settled ? 0 : 1;
        }
    double mean = 0.;
    for (const double number : designs)
      mean += number / static_cast<double>(designs.size());
    if (tells)
      std::cout << designs.size() << " searches: designs " << mean << ", 90 % " << quantile(designs, 0.9)
                << ", left " << quantile(left, 0.5) << ", 90 % " << quantile(left, 0.9) << ", excess 90 % "
                << quantile(excess, 0.9) << ", unsettled " << n_unsettled << "\n";
    std::cout << "noise of " << 100. * part << " %: optima known of all but 5: " << answer(n_without <= 5)
              << "; at most 8 designs: " << answer(mean <= 8.)
              << ", 90 % at most 14: " << answer(quantile(designs, 0.9) <= 14.)
              << "; no more left than the noise: " << answer(quantile(left, 0.5) <= part)
              << ", 90 % than three times that: " << answer(quantile(left, 0.9) <= 3. * part)
              << "; limits kept to it: " << answer(quantile(excess, 0.9) <= 1.5 * part)
              << "; unsettled at most 2 %: " << answer(n_unsettled <= 7) << "\n";
  }
}
