// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Conduction in a body.
// - T = 100 + 50 cos(pi x) cos(pi y) cos(pi z) exp(-3 pi² alpha t) in an insulated unit cube: the error falls with the
//   square of the size of elements, with nodes moved at random too, and with the square of steps of time.
// - A bar that is stretched, x = X exp(a t), and grows thin: T = 100 + 50 cos(pi X) exp(-alpha pi² (1 - exp(-2at))/(2a)),
//   by halves of steps before and after its motion: order 2 in time.
// - Twenty boxes with nodes moved at random, dies at both ends and free sides, from a jump of the temperature: none
//   leaves the range of what it was made of by more than rounding, in short steps and in long ones; and the heat that came
//   in is that in the body.
// - A conductance that is no number has no temperatures: NoLinearSolution, for which increments are halved.

#include "heat_test_tools.h"

#include <retroforge/heat/network_matrix.h>
#include <retroforge/linear_algebra/direct_solver.h>

#include <algorithm>
#include <functional>

using namespace retroforge;

namespace
{
  /// Nodes within moved by a part of the element size, those of the surface along it.
  void shake(const Vec3 &size, const double amount, RandomNumbers &numbers, NodalVectors<double> &X)
  {
    for (Vec3 &x : X)
    {
      const Vec3 move = amount * numbers.vector();
      for (unsigned int i = 0; i < 3; ++i)
        if (x[i] > 1e-9 && x[i] < size[i] - 1e-9)
          x[i] += move[i];
    }
  }

  double norm_of_error(const Body                                &body,
                       const NodalVectors<double>                &X,
                       const std::vector<double>                 &T,
                       const std::function<double(const Vec3 &)> &exact,
                       const NodalVectors<double>                &at)
  {
    const auto network = conduction_network(body.mesh, body.edges, X);
    double     sum = 0., volume = 0.;
    for (NodeIndex k = 0; k < T.size(); ++k)
    {
      sum += network.volumes[k] * std::pow(T[k] - exact(at[k]), 2);
      volume += network.volumes[k];
    }
    return std::sqrt(sum / volume);
  }

  /// In a cube of n³ blocks, with steps of time.
  double cube_error(const unsigned int n, const unsigned int steps, const double shaken)
  {
    const Vec3    size({1., 1., 1.});
    Body          body(box_mesh(size, {{n, n, n}}));
    RandomNumbers numbers;
    shake(size, shaken / n, numbers, body.mesh.X);
    HeatLaw<double>  law   = steel();
    constexpr double time  = 0.01;
    const double     alpha = law.conductivity / law.capacity;
    const auto       exact = [&](const double t) {
      return [=](const Vec3 &x) {
        return 100. + 50. * std::cos(M_PI * x[0]) * std::cos(M_PI * x[1]) * std::cos(M_PI * x[2]) *
                        std::exp(-3. * M_PI * M_PI * alpha * t);
      };
    };
    std::vector<double> T;
    NodeSkins<double>   skin = body.no_skins();
    for (const Vec3 &x : body.mesh.X)
      T.push_back(exact(0.)(x));
    body.conduct(law, body.mesh.X, time, steps, T, skin);
    return norm_of_error(body, body.mesh.X, T, exact(time), body.mesh.X);
  }

  void print_order(const std::string &name, const std::vector<double> &errors)
  {
    std::cout << name << ": orders";
    for (std::size_t i = 1; i < errors.size(); ++i)
      std::cout << ' ' << std::round(100. * std::log2(errors[i - 1] / errors[i])) / 100.;
    std::cout << ", last above 1.9: " << yes(std::log2(errors[errors.size() - 2] / errors.back()) > 1.9)
              << "\n";
  }

  /// Temperatures of a stretched bar after n steps.
  std::vector<double> stretched(const Body &body, const unsigned int n)
  {
    constexpr double a = 30., time = 0.02;
    const auto       at = [&](const double t) {
      NodalVectors<double> X = body.mesh.X;
      for (Vec3 &x : X)
        x = Vec3({x[0] * std::exp(a * t), x[1] * std::exp(-0.5 * a * t), x[2] * std::exp(-0.5 * a * t)});
      return X;
    };
    std::vector<double> T;
    NodeSkins<double>   skin = body.no_skins();
    for (const Vec3 &x : body.mesh.X)
      T.push_back(100. + 50. * std::cos(M_PI * x[0]));
    for (unsigned int i = 0; i < n; ++i)
      for (const unsigned int end : {0, 1})
        body.conduct(steel(), at((i + end) * time / n), 0.5 * time / n, 1, T, skin);
    return T;
  }

  void check_stretching()
  {
    const auto bar = [](const unsigned int n) {
      return Body(box_mesh(Vec3({1., 0.25, 0.25}), {{n, n / 4, n / 4}}));
    };
    // Against the closed form, in space and time together.
    std::vector<double> errors;
    for (const unsigned int n : {8, 16, 32})
    {
      const Body       body = bar(n);
      constexpr double a = 30., time = 0.02;
      const double     alpha = steel().conductivity / steel().capacity;
      const double     decay = std::exp(-alpha * M_PI * M_PI * (1. - std::exp(-2. * a * time)) / (2. * a));
      const auto       exact = [&](const Vec3 &X) { return 100. + 50. * std::cos(M_PI * X[0]) * decay; };
      errors.push_back(norm_of_error(body, body.mesh.X, stretched(body, n), exact, body.mesh.X));
    }
    print_order("stretched bar, elements and steps", errors);
    // And in time alone, by differences of runs.
    const Body                       body = bar(16);
    std::vector<std::vector<double>> runs;
    for (const unsigned int n : {8, 16, 32, 64})
      runs.push_back(stretched(body, n));
    std::vector<double> differences;
    for (std::size_t i = 1; i < runs.size(); ++i)
    {
      double largest = 0.;
      for (NodeIndex k = 0; k < runs[i].size(); ++k)
        largest = std::max(largest, std::abs(runs[i][k] - runs[i - 1][k]));
      differences.push_back(largest);
    }
    print_order("stretched bar, steps", differences);
  }

  void check_bounds()
  {
    RandomNumbers numbers;
    double        over = 0., unbalanced = 0.;
    unsigned int  n_obtuse = 0;
    for (unsigned int scene = 0; scene < 20; ++scene)
    {
      const Vec3 size({10., 10., 6. + 4. * numbers.scalar()});
      Body       body(box_mesh(size, {{5, 5, 3}}),
                {Die("lower", Vec3(), Vec3({0., 0., 1.})), Die("upper", size, Vec3({0., 0., -1.}))});
      shake(size, 0.6, numbers, body.mesh.X);
      body.states[0].temperature = 150.;
      body.states[1].temperature = 300.;
      HeatLaw<double> law        = steel();
      law.contact_film           = 15.;
      law.air_film               = 0.02;
      law.emissivity             = 0.8;
      const auto network         = conduction_network(body.mesh, body.edges, body.mesh.X);
      n_obtuse += std::count_if(
        network.conductances.begin(), network.conductances.end(), [](const double g) { return g < 0.; });
      for (const double dt : {1e-4, 1e-2, 1.})
      {
        std::vector<double> T;
        NodeSkins<double>   skin = body.no_skins();
        for (const Vec3 &x : body.mesh.X)
          T.push_back(x[0] < 5. ? 900. : 1200.);
        double heat = 0.;
        for (NodeIndex k = 0; k < T.size(); ++k)
          heat -= law.capacity * network.volumes[k] * T[k];
        const double scale = -heat;
        double       in    = 0.;
        for (unsigned int i = 0; i < 5; ++i)
        {
          in += body.conduct(law, body.mesh.X, dt, 1, T, skin);
          over = std::max(over, *std::max_element(T.begin(), T.end()) - 1200.);
          over = std::max(over, 20. - *std::min_element(T.begin(), T.end()));
          // Where nothing has arrived, the jump does not swing.
          if (i == 0 && dt == 1e-4)
            over = std::max(over, 150. - *std::min_element(T.begin(), T.end()));
        }
        for (NodeIndex k = 0; k < T.size(); ++k)
          heat += law.capacity * network.volumes[k] * T[k];
        unbalanced = std::max(unbalanced, std::abs(heat - in) / scale);
      }
    }
    std::cout << "20 shaken boxes with obtuse angles: " << yes(n_obtuse > 100)
              << ", temperatures within what they are made of: " << yes(over < 1e-6)
              << ", heat balanced: " << yes(unbalanced < 1e-11) << "\n";
    if (over >= 1e-6 || unbalanced >= 1e-11)
      std::cout << "  " << over << ' ' << unbalanced << "\n";
  }

  void check_no_solution()
  {
    const TetMesh       mesh = box_mesh(Vec3({1., 1., 1.}), {1, 1, 1});
    const NetworkEdges  edges(mesh, Topology(mesh));
    std::vector<double> couplings(conduction_network(mesh, edges, mesh.X).conductances.size(), 1.);
    couplings[0] = std::nan("");
    const std::vector<double> ones(mesh.n_nodes(), 1.);
    try
    {
      NetworkMatrix(edges, ones, couplings).solve(ones, std::vector<double>(ones.size(), 0.));
      std::cout << "no solution: NO\n";
    }
    catch (const NoLinearSolution &error)
    {
      std::cout << "no solution: " << error.what() << "\n";
    }
  }
} // namespace

int main()
{
  print_order("cube, elements", {cube_error(4, 64, 0.), cube_error(8, 64, 0.), cube_error(16, 64, 0.)});
  print_order("shaken cube, elements",
              {cube_error(4, 64, 0.15), cube_error(8, 64, 0.15), cube_error(16, 64, 0.15)});
  const double fine = cube_error(6, 512, 0.);
  print_order("cube, steps of time",
              {std::abs(cube_error(6, 4, 0.) - fine),
               std::abs(cube_error(6, 8, 0.) - fine),
               std::abs(cube_error(6, 16, 0.) - fine)});
  check_stretching();
  check_bounds();
  check_no_solution();
}
