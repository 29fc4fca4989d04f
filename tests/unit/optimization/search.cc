// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The search on functions in place of forgings, whose optimum is known on paper: the point of a disk nearest
// to one outside of it, from inside and outside, with the multiplier of the disk's limit; the same where a
// limit does not press; with a relation beside it; where a part of the plane has no values; among data; in
// noise, on meshes made anew on the way, and with few designs allowed. Its gradient check, and what it asks
// for and tells.

#include <retroforge/objective/energy.h>
#include <retroforge/optimization/search.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

using namespace retroforge;

namespace
{
  using Vector = std::vector<double>;

  const char *answer(const bool yes)
  {
    return yes ? "yes" : "NO";
  }

  /// f = (a - 1)^2 + 2 (b - 2)^2,  g = a^2 + b^2,  and h = 1000 + a, of a and b.
  struct Functions
  {
    double noise = 0., fails_above = INFINITY; ///< of f; no values where a + b is larger
    double by_mesh           = 0.;             ///< added to f
    double noise_of_gradient = 0.;             ///< of f's
    double noise_of_g        = 0.;
    double kink              = 0.; ///< of f, times the distance of a and b

    Evaluation operator()(const Vector &mu, const bool with_gradients) const
    {
      const double a = mu[0], b = mu[1];
      Evaluation   evaluation;
      evaluation.mu = mu;
      if (a + b > fails_above)
      {
        evaluation.failure = "too large";
        return evaluation;
      }
      const double rough = noise * std::sin(1e7 * (a + 3. * b));
      const double of_g  = noise_of_g * std::sin(3e7 * (2. * a + b));
      evaluation.values  = {std::pow(a - 1., 2) + 2. * std::pow(b - 2., 2) + rough + by_mesh +
                              kink * std::abs(a - b),
                            a * a + b * b + of_g,
                            1000. + a};
      if (with_gradients)
        evaluation.gradients = {
          {2. * (a - 1.) + noise_of_gradient * std::cos(1e7 * b) + (a > b ? kink : -kink),
           4. * (b - 2.) - (a > b ? kink : -kink)},
          {2. * a, 2. * b},
          {1., 0.}};
      return evaluation;
    }
  };

  /// A search among them, and what it asked for.
  class Problem
  {
  public:
    OptimizationParameters   parameters;
    std::vector<std::string> varied = {"a", "b"};
    Functions                functions;
    std::vector<Vector>      evaluated;
    unsigned int             n_swept = 0, n_accepted = 0, n_refused = 0, n_failed = 0, n_renewed = 0;
    bool                     tells_in_turn = true;
    double                   mesh_reach    = INFINITY; ///< of f's mesh, in a and b from where it was made
    unsigned int             n_meshes = 0, n_refused_meshes = 0;
    bool                     meshes_fail = false, knows_noise_of_g = true;
    Evaluation               end;
    Vector                   multipliers;
    SearchStop               stop    = SearchStop::running;
    bool                     settled = false;

    Problem()
    {
      parameters.objective          = {"f"};
      parameters.scales             = {{"a", 0.5}, {"b", 0.5}};
      parameters.first_step         = 1.;
      parameters.gradient_tolerance = 1e-7;
      parameters.limit_tolerance    = 1e-9;
    }

    void run(const Vector &start)
    {
      with_search(start, [&](Search &search) {
        search.set_noise(functions.noise,
                         {functions.noise, knows_noise_of_g ? functions.noise_of_g : 0., 0.});
        settled     = search.run();
        end         = search.now();
        multipliers = search.multipliers();
        stop        = search.stop();
      });
    }

    template <typename Use>
    void with_search(const Vector &start, const Use &use)
    {
      Objectives objectives(3);
      for (unsigned int o = 0; o < 3; ++o)
      {
        objectives[o].name  = std::vector<std::string>{"f", "g", "h"}[o];
        objectives[o].path  = std::make_unique<EnergyObjective>();
        objectives[o].least = -std::numeric_limits<double>::infinity();
      }
      const std::vector<DesignParameter> all = {{"a", "mm", DesignParameter::Kind::billet, 1., 1.},
                                                {"b", "mm", DesignParameter::Kind::billet, 1., 1.}};
      const DesignSpace                  space(all, varied, start, parameters);
      Criteria                           criteria(objectives, parameters);
      SearchTask                         task;
      task.evaluate = [&](const Vector &mu) {
        if (std::find(evaluated.begin(), evaluated.end(), mu) == evaluated.end())
          evaluated.push_back(mu);
        return functions(mu, false);
      };
      task.differentiate = [&](const Vector &mu) {
        tells_in_turn = tells_in_turn && std::find(evaluated.begin(), evaluated.end(), mu) != evaluated.end();
        ++n_swept;
        return functions(mu, true);
      };
      task.n_evaluated = [&] { return evaluated.size(); };
      task.decided     = [&](const Evaluation &evaluation, const bool accepted) {
        tells_in_turn = tells_in_turn && evaluation.mu == evaluated.back();
        ++(accepted ? n_accepted : n_refused);
        n_failed += evaluation.failed() ? 1 : 0;
      };
      task.renewed     = [&](double) { ++n_renewed; };
      Vector made_at   = start, settled_at;
      task.mesh_is_bad = [&](const Evaluation &now) {
        return std::hypot(now.mu[0] - made_at[0], now.mu[1] - made_at[1]) > mesh_reach &&
               now.mu != settled_at;
      };
      task.renew_mesh = [&](const Evaluation &now) -> std::optional<Evaluation> {
        if (meshes_fail)
        {
          ++n_refused_meshes;
          settled_at = now.mu;
          return {};
        }
        ++n_meshes;
        made_at = now.mu;
        functions.by_mesh += 0.01;
        evaluated.push_back(now.mu);
        return functions(now.mu, true);
      };
      task.evaluate(start);
      const Evaluation at_start = task.differentiate(start);
      criteria.set_sizes(at_start.values);
      Search search(space, criteria, parameters, task);
      search.begin(at_start);
      use(search);
    }

    double distance(const Vector &mu) const { return std::hypot(end.mu[0] - mu[0], end.mu[1] - mu[1]); }
  };

  /// Of the least f in the disk g <= 1: a = 1 / (1 + lambda), b = 4 / (2 + lambda), their squares' sum 1.
  double multiplier_of_disk()
  {
    double low = 0., high = 100.;
    while (high - low > 1e-15 * high)
    {
      const double lambda = 0.5 * (low + high);
      const double g      = std::pow(1. / (1. + lambda), 2) + std::pow(4. / (2. + lambda), 2);
      if (lambda == low || lambda == high)
        break;
      (g > 1. ? low : high) = lambda;
    }
    return low;
  }

  void check_disk(const std::string &name, const Vector &start)
  {
    Problem problem;
    problem.parameters.at_most = {{"g", 1.}};
    problem.run(start);
    const double lambda = multiplier_of_disk();
    std::cout << name << ": settled " << answer(problem.settled) << ", optimum to 1e-6 "
              << answer(problem.distance({1. / (1. + lambda), 4. / (2. + lambda)}) < 1e-6)
              << ", its multiplier to 1e-5 "
              << answer(std::abs(problem.multipliers[0] - lambda) < 1e-5 * lambda) << ", at most 20 designs "
              << answer(problem.evaluated.size() <= 20) << ", rounds told " << answer(problem.n_renewed > 0)
              << ", asked in turn " << answer(problem.tells_in_turn)
              << ", a gradient of each accepted design only "
              << answer(problem.n_swept <= problem.n_accepted + 1 + problem.n_renewed + 1) << "\n";
  }
} // namespace

int main()
{
  {
    Problem problem;
    problem.run({0.2, 0.3});
    std::cout << "free: optimum to 1e-6 " << answer(problem.distance({1., 2.}) < 1e-6)
              << ", for its gradient " << answer(problem.stop == SearchStop::gradient)
              << ", at most 15 designs " << answer(problem.evaluated.size() <= 15) << "\n";
  }
  check_disk("disk, from inside", {0.2, 0.3});
  check_disk("disk, from outside", {1.5, 1.5});
  {
    Problem problem;
    problem.parameters.at_most = {{"g", 9.}};
    problem.run({0.2, 0.3});
    std::cout << "a limit that does not press: optimum to 1e-6 " << answer(problem.distance({1., 2.}) < 1e-6)
              << ", multiplier " << problem.multipliers[0] << ", settled " << answer(problem.settled) << "\n";
  }
  {
    // At least 9: the nearest point outside of a disk that has the free optimum in it.
    Problem problem;
    problem.parameters.at_least = {{"g", 9.}};
    problem.run({0.2, 0.3});
    const double g = problem.end.values[1];
    // f and g have parallel gradients there: a - 1 : 2 (b - 2) = a : b.
    const double a = problem.end.mu[0], b = problem.end.mu[1];
    std::cout << "a lower limit: kept to 1e-7 " << answer(std::abs(g - 9.) < 1e-7)
              << ", gradients parallel to 1e-5 " << answer(std::abs((a - 1.) * b - 2. * (b - 2.) * a) < 1e-5)
              << ", multiplier positive " << answer(problem.multipliers[0] > 0.) << "\n";
  }
  {
    // Two limits, one in a unit in which it hardly changes, as temperatures: a <= 0.3 at the edge of a disk, among noise.
    bool         settled = true;
    unsigned int most    = 0;
    double       worst   = 0.;
    for (const double a : {1.5, 0.9, 0.2})
    {
      Problem problem;
      problem.functions.noise            = 1e-3;
      problem.parameters.at_most         = {{"g", 3.}, {"h", 1000.3}};
      problem.parameters.limit_tolerance = 1e-5;
      problem.run({a, 1.5});
      settled = settled && problem.settled;
      most    = std::max<unsigned int>(most, problem.evaluated.size());
      worst   = std::max(worst, problem.distance({0.3, std::sqrt(3. - 0.09)}));
    }
    std::cout << "two limits of unlike units: settled " << answer(settled) << ", optimum to 1e-3 "
              << answer(worst < 1e-3) << ", at most 10 designs " << answer(most <= 10) << "\n";
  }
  {
    // The same disk where its limit is rough: from 40 starts the mean distance that is left.
    double left[2] = {0., 0.}, designs[2] = {0., 0.};
    for (const bool knows : {false, true})
      for (const double a : {1.8, 1.5, 1.2, 0.9, 0.6, 0.4, 0.2, 0.})
        for (const double b : {2., 1.75, 1.5, 1., 0.5})
        {
          Problem problem;
          problem.functions.noise        = 1e-3;
          problem.functions.noise_of_g   = 0.1;
          problem.knows_noise_of_g       = knows;
          problem.parameters.at_most     = {{"g", 3.}};
          problem.parameters.simulations = 40;
          problem.run({a, b});
          left[knows] += problem.distance({0.66591858, 1.59892228}) / 40.;
          designs[knows] += problem.evaluated.size() / 40.;
        }
    const double by_noise = 0.1 / (2. * std::sqrt(3.)); // of the disk's edge
    std::cout << "a rough limit, from 40 starts: nearer to the optimum than its noise "
              << answer(left[true] < by_noise) << ", and by less than 0.8 of what is left without knowing it "
              << answer(left[true] < 0.8 * left[false]) << ", with fewer designs "
              << answer(designs[true] < designs[false]) << "\n";
  }
  {
    // a + b <= 1 cuts the disk before its edge: (a - 1) = 2 (b - 2), so a = -1 / 3 + ... by hand: b = 4/3.
    Problem problem;
    problem.parameters.at_most   = {{"g", 4.}};
    problem.parameters.relations = {"a + b <= 1"};
    problem.run({0.2, 0.3});
    std::cout << "a relation before the limit: optimum to 1e-6 "
              << answer(problem.distance({-1. / 3., 4. / 3.}) < 1e-6) << ", the limit's multiplier "
              << problem.multipliers[0] << "\n";
  }
  {
    Problem problem;
    problem.functions.fails_above = 2.; // the free optimum is where there are no values
    problem.run({0.2, 0.3});
    // Least on the line a + b = 2:  a - 1 = 2 (b - 2)  gives (1/3, 5/3), value 2/3.
    const double start = Functions()({0.2, 0.3}, false).values[0],
                 part  = (start - problem.end.values[0]) / (start - 2. / 3.);
    // From 40 starts on a grid, some close to that line: 30 steps go most of the way along it.
    double mean = 0.;
    for (const double a : {-1., -0.5, 0., 0.2, 0.4, 0.6, 0.8, 1.})
      for (const double b : {-0.5, 0., 0.3, 0.6, 0.9})
      {
        Problem from_there;
        from_there.functions.fails_above = 2.;
        from_there.run({a, b});
        const double value = Functions()({a, b}, false).values[0];
        mean += (value - from_there.end.values[0]) / (value - 2. / 3.) / 40.;
      }
    std::cout << "where there are no values: refused " << answer(problem.n_failed > 0)
              << ", stays beside them " << answer(problem.end.mu[0] + problem.end.mu[1] <= 2.)
              << ", 97 % of the way to the least that there is " << answer(part > 0.97)
              << ", from everywhere 90 % " << answer(mean > 0.9) << "\n";
  }
  {
    // Data of f and g at (0.8, 1.1), exact: the Hessian is known where they agree.
    Problem problem;
    problem.parameters.objective     = {};
    const Vector values              = Functions()({0.8, 1.1}, false).values;
    problem.parameters.data          = {{"f", values[0]}, {"g", values[1]}};
    problem.parameters.uncertainties = {{"f", 0.01}, {"g", 0.01}};
    problem.run({0.5, 0.8});
    std::cout << "data: found to 1e-6 " << answer(problem.distance({0.8, 1.1}) < 1e-6)
              << ", at most 10 designs " << answer(problem.evaluated.size() <= 10);
    // From far off the gradient has fallen by any part of it long before the misfit is less than deviations.
    problem.parameters.gradient_tolerance = 0.5;
    problem.run({-4., 6.});
    const double misfit = 0.5 * (std::pow((problem.end.values[0] - values[0]) / 0.01, 2) +
                                 std::pow((problem.end.values[1] - values[1]) / 0.01, 2));
    std::cout << ", by a loose tolerance from far off to a tenth of their deviations "
              << answer(misfit < 0.01) << "\n";
  }
  {
    Problem problem;
    problem.functions.noise             = 1e-3;
    problem.functions.noise_of_gradient = 0.03;
    problem.run({0.2, 0.3});
    std::cout << "noise: ended for it " << answer(problem.stop == SearchStop::noise) << ", within some of it "
              << answer(problem.end.values[0] < 10. * 1e-3) << "\n";
  }
  {
    // Where it has ended for a noise that is not there, it goes on when told so.
    Problem problem;
    bool    ended = false;
    Vector  there;
    problem.with_search({0.2, 0.3}, [&](Search &search) {
      search.set_noise(0.5);
      search.run();
      ended = search.stop() == SearchStop::noise;
      there = search.now().mu;
      search.set_noise(0.);
      search.run();
      problem.end  = search.now();
      problem.stop = search.stop();
    });
    std::cout << "less noise than told: ended for it "
              << answer(ended && std::hypot(there[0] - 1., there[1] - 2.) > 1e-2) << ", then optimum to 1e-6 "
              << answer(problem.distance({1., 2.}) < 1e-6 && problem.stop == SearchStop::gradient) << "\n";
  }
  {
    // A noise of more than all that the objective changes by between the bounds, where it is the same: to and fro.
    Problem problem;
    problem.varied            = {"a"};
    problem.parameters.scales = {{"a", 1.}};
    problem.parameters.lower  = {{"a", 0.5}};
    problem.parameters.upper  = {{"a", 1.5}};
    problem.with_search({0.5, 2.}, [&](Search &search) {
      search.set_noise(2.);
      search.run();
      problem.stop = search.stop();
    });
    std::cout << "nothing but noise: ends " << answer(problem.stop == SearchStop::noise)
              << ", after few designs " << answer(problem.evaluated.size() <= 5) << "\n";
  }
  {
    // Along a kink each step gains a little.
    Problem problem, goes_on;
    for (Problem *of : {&problem, &goes_on})
    {
      of->functions.by_mesh     = 100.;
      of->functions.kink        = 2.;
      of->parameters.least_gain = of == &problem ? 1e-3 : 0.;
      of->run({0.2, -1.3});
    }
    constexpr double least = 100. + 2. / 3.;
    std::cout << "along a kink: ends for gains " << answer(problem.stop == SearchStop::gains)
              << ", within 1e-3 of the value " << answer(problem.end.values[0] < (1. + 1e-3) * least)
              << ", after at most 14 designs " << answer(problem.evaluated.size() <= 14)
              << "; goes on where told so "
              << answer(goes_on.evaluated.size() > 20 && goes_on.end.values[0] < (1. + 1e-4) * least) << "\n";
  }
  {
    // Each mesh adds something of its own to the values: nothing of that is taken for a step's.
    Problem problem;
    problem.mesh_reach = 0.7;
    problem.run({0.2, 0.3});
    Problem limited;
    limited.mesh_reach         = 0.3;
    limited.parameters.at_most = {{"g", 1.}};
    limited.run({0.2, 0.3});
    Problem failing;
    failing.mesh_reach  = 0.7;
    failing.meshes_fail = true;
    failing.run({0.2, 0.3});
    std::cout << "meshes made anew: " << answer(problem.n_meshes > 0) << ", optimum to 1e-6 "
              << answer(problem.distance({1., 2.}) < 1e-6) << ", at most 18 designs "
              << answer(problem.evaluated.size() <= 18) << ", with a limit " << answer(limited.n_meshes > 0)
              << ", settled " << answer(limited.settled) << "\n"
              << "meshes that fail: asked for once at a design "
              << answer(failing.n_refused_meshes > 0 && failing.n_refused_meshes <= failing.n_accepted)
              << ", optimum to 1e-6 " << answer(failing.distance({1., 2.}) < 1e-6) << "\n";
  }
  {
    // The slope by what is not varied is 1000 times that by what is.
    Problem problem;
    problem.varied                        = {"a"};
    problem.parameters.scales             = {{"a", 0.5}};
    problem.parameters.gradient_tolerance = 1e-3;
    problem.run({0.2, -500.});
    std::cout << "beside a parameter that is not varied: optimum to 1e-3 "
              << answer(std::abs(problem.end.mu[0] - 1.) < 1e-3) << ", it stays "
              << answer(problem.end.mu[1] == -500.) << "\n";
  }
  {
    // a^2 + b^2 is never negative: the nearest design is where it is least.
    Problem problem;
    problem.parameters.at_most = {{"g", -1.}};
    problem.run({0.2, 0.3});
    Problem felt_by_none;
    felt_by_none.varied             = {"a"};
    felt_by_none.parameters.scales  = {{"a", 0.5}};
    felt_by_none.parameters.at_most = {{"g", 0.5}};
    felt_by_none.run({0., 1.}); // g is stationary in a
    std::cout << "limits that cannot be met: told " << answer(problem.stop == SearchStop::limits)
              << ", not settled " << answer(!problem.settled) << ", as near as can be to 1e-2 "
              << answer(problem.distance({0., 0.}) < 1e-2) << ", as well where none moves them "
              << answer(felt_by_none.stop == SearchStop::limits && std::isfinite(felt_by_none.end.mu[0]))
              << "\n";
  }
  {
    Problem problem;
    problem.parameters.simulations = 4;
    problem.run({0.2, 0.3});
    std::cout << "few designs: " << problem.evaluated.size() << ", told "
              << answer(problem.stop == SearchStop::simulations) << "\n";
  }
  {
    Problem problem;
    problem.parameters.at_most = {{"g", 0.05}}; // exceeded, so that the penalty is felt
    double worst               = 0.;
    problem.with_search({0.2, 0.3}, [&](Search &search) { worst = search.check()[1].error; });
    std::cout << "gradient check at a step of 1e-2: to 1e-2 " << answer(worst > 0. && worst < 1e-2) << "\n";
  }
}
