// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The minimizer on functions whose minima are known: Rosenbrock's valley, free and with a bound that holds
// its minimum back; one that has no value in a part of the plane, which must be walked around; one that is
// rough, where steps within the noise are taken and the search ends when asked; one whose start is its
// minimum; one of squares, whose Hessian is known; one that bends downwards; and one with a limit's kink on the way,
// which the model must know before it is passed.

#include <retroforge/optimization/minimize.h>

#include <cmath>
#include <iostream>
#include <limits>

using namespace retroforge;

namespace
{
  using Vector = BoundedProblem::Vector;

  constexpr double infinity = std::numeric_limits<double>::infinity();

  const char *answer(const bool yes)
  {
    return yes ? "yes" : "NO";
  }

  double rosenbrock(const Vector &x)
  {
    return 10. * std::pow(x[1] - x[0] * x[0], 2) + std::pow(1. - x[0], 2);
  }

  Vector rosenbrock_gradient(const Vector &x)
  {
    const double bend = x[1] - x[0] * x[0];
    return {-40. * x[0] * bend - 2. * (1. - x[0]), 20. * bend};
  }

  /// Counts what is asked, and whether it is asked as promised.
  struct Counted
  {
    BoundedProblem problem;
    unsigned int   values = 0, gradients = 0, refused = 0;
    bool           decided_in_turn = true;
    double         last            = infinity;

    Counted(const Vector &start, const Vector &lower, const Vector &upper)
    {
      problem.start = start;
      problem.lower = lower;
      problem.upper = upper;
      problem.value = [this](const Vector &x) {
        ++values;
        return last = value(x);
      };
      problem.linearize = [this](const Vector &x) {
        ++gradients;
        return linearize(x);
      };
      problem.decided = [this](const Vector &x, const bool accepted) {
        refused += accepted ? 0 : 1;
        decided_in_turn &= value(x) == last && !(accepted && std::isinf(last));
      };
    }
    Counted(const Counted &) = delete;

    std::function<double(const Vector &)>        value     = rosenbrock;
    std::function<Linearization(const Vector &)> linearize = [](const Vector &x) {
      return Linearization{rosenbrock_gradient(x), {}};
    };
  };

  MinimizerSettings until(const double gradient, const unsigned int iterations)
  {
    MinimizerSettings settings;
    settings.first_radius = 0.5;
    settings.go_on        = [=](const MinimizerState &state) {
      return state.gradient > gradient && state.iteration < iterations;
    };
    return settings;
  }

  void report(const std::string &what, const Vector &x, const Vector &expected, const Counted &counted)
  {
    const double error = std::max(std::abs(x[0] - expected[0]), std::abs(x[1] - expected[1]));
    std::cout << what << ": found to 1e-5: " << answer(error < 1e-5)
              << "; in less than 60 values: " << answer(counted.values < 60)
              << "; one gradient for each accepted: "
              << answer(counted.gradients == counted.values - counted.refused)
              << "; decided in turn: " << answer(counted.decided_in_turn) << "\n";
  }
} // namespace

int main()
{
  {
    Counted      counted({-1., 1.}, {-infinity, -infinity}, {infinity, infinity});
    const Vector x = Minimizer().minimize(counted.problem, until(1e-7, 200));
    report("free", x, {1., 1.}, counted);
  }
  {
    Counted      counted({-1., 1.}, {-2., -infinity}, {0.5, infinity});
    const Vector x = Minimizer().minimize(counted.problem, until(1e-7, 200));
    report("bounded", x, {0.5, 0.25}, counted);
  }
  {
    // A hole in its way down the valley.
    Counted counted({-1., 1.}, {-infinity, -infinity}, {infinity, infinity});
    counted.value = [](const Vector &x) {
      return std::pow(x[0] + 0.2, 2) + std::pow(x[1] - 0.3, 2) < 0.04 ? infinity : rosenbrock(x);
    };
    const Vector x = Minimizer().minimize(counted.problem, until(1e-7, 200));
    report("with a hole", x, {1., 1.}, counted);
    std::cout << "points in the hole were refused: " << answer(counted.refused > 0) << "\n";
  }
  {
    constexpr double noise = 1e-3;
    Counted          counted({-1., 1.}, {-infinity, -infinity}, {infinity, infinity});
    counted.value = [](const Vector &x) {
      return rosenbrock(x) + noise * std::sin(1e5 * x[0]) * std::cos(1e5 * x[1]);
    };
    counted.linearize = [](const Vector &x) { return Linearization{rosenbrock_gradient(x), {}, 2. * noise}; };
    const Vector x    = Minimizer().minimize(counted.problem, until(1e-3, 200));
    std::cout << "rough: within the noise of the minimum: " << answer(rosenbrock(x) < noise)
              << "; in less than 60 values: " << answer(counted.values < 60) << "\n";
  }
  {
    // Minima along a line and in a wedge, whose multipliers are known: the gradient is along the weights.
    Counted      counted({-1., 1.5}, {-infinity, -infinity}, {infinity, infinity});
    const Vector slanted = {std::sqrt(0.5), std::sqrt(0.5)};
    for (const bool is_equation : {true, false})
    {
      const double bound        = 0.5 * std::sqrt(0.5);
      counted.problem.relations = {{"", slanted, is_equation ? bound : -infinity, bound}};
      const Vector x            = Minimizer().minimize(counted.problem, until(1e-9, 200));
      const Vector g            = rosenbrock_gradient(x);
      std::cout << (is_equation ? "equation" : "inequality")
                << ": kept to 1e-9: " << answer(std::abs(x[0] + x[1] - 0.5) < 1e-9)
                << "; gradient along its weights to 1e-6: "
                << answer(std::abs(g[0] - g[1]) < 1e-6 && (is_equation || g[0] < 0.)) << "\n";
    }
    counted.problem.relations = {{"", slanted, -infinity, std::sqrt(0.5)}, {"", {1., 0.}, -infinity, 0.3}};
    const Vector x            = Minimizer().minimize(counted.problem, until(1e-9, 200));
    std::cout << "two, one of which is felt: "
              << answer(std::abs(x[0] - 0.3) < 1e-6 && std::abs(x[1] - 0.09) < 1e-6) << "\n";
  }
  {
    Counted counted({1., 1.}, {-infinity, -infinity}, {infinity, infinity});
    Minimizer().minimize(counted.problem, until(1e-7, 200));
    std::cout << "begins at its minimum: one value: " << answer(counted.values == 1) << "\n";
  }
  {
    // Gauss and Newton's Hessian of its two squares: all that is known, and all but what is learned.
    for (const bool learns : {false, true})
    {
      Counted counted({-1., 1.}, {-infinity, -infinity}, {infinity, infinity});
      counted.linearize = [&](const Vector &x) {
        return Linearization{{0., 0.},
                             {{x[1] - x[0] * x[0], {-2. * x[0], 1.}, 20.}, {1. - x[0], {-1., 0.}, 2.}}};
      };
      counted.problem.learns = learns;
      const Vector x         = Minimizer().minimize(counted.problem, until(1e-7, 200));
      report(learns ? "by squares and what they leave" : "by squares", x, {1., 1.}, counted);
      std::cout << "in less than 30 values: " << answer(counted.values < 30) << "\n";
    }
  }
  {
    // A saddle: what bends downwards is followed to its bound by as long steps as there may be.
    Counted counted({1., 1.}, {0., -infinity}, {50., infinity});
    counted.value     = [](const Vector &x) { return -x[0] * x[0] + 0.5 * x[0] * x[1] + x[1] * x[1]; };
    counted.linearize = [](const Vector &x) {
      return Linearization{{-2. * x[0] + 0.5 * x[1], 0.5 * x[0] + 2. * x[1]}, {}};
    };
    const Vector x = Minimizer().minimize(counted.problem, until(1e-7, 200));
    report("a saddle", x, {50., -12.5}, counted);
    std::cout << "in less than 20 values: " << answer(counted.values < 20) << "\n";
  }
  {
    // (a - 4)^2 + (b - 1)^2, and a <= 1 by a penalty that is 1000 times as stiff, which the start does not feel.
    Counted    counted({-3., 0.}, {-infinity, -infinity}, {infinity, infinity});
    const auto limit = [](const double a) { return PenaltyTerm{a - 1., {1., 0.}, 2000., true, 1.}; };
    counted.value    = [&](const Vector &x) {
      return std::pow(x[0] - 4., 2) + std::pow(x[1] - 1., 2) + limit(x[0]).value(x[0] - 1.);
    };
    counted.linearize = [&](const Vector &x) {
      return Linearization{{2. * (x[0] - 4.), 2. * (x[1] - 1.)}, {limit(x[0])}};
    };
    const Vector x = Minimizer().minimize(counted.problem, until(1e-7, 200));
    // 2 (a - 4) + 1 + 2000 (a - 1) = 0.
    report("a kink", x, {2007. / 2002., 1.}, counted);
    std::cout << "in at most 10 values, none refused: "
              << answer(counted.values <= 10 && counted.refused == 0) << "\n";
  }
}
