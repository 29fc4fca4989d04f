// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Metal that arrives at a die within an increment gives heat from then on.
// - A block that falls on a plane: the time for which a node touches, over two increments, is that after its arrival, to rounding,
//   whenever that is, and the same whether the metal comes or the die; where the metal's velocity is not known, as if it rested.
//   Metal that goes along the die, or away, has not arrived; what touched at the start but not at the end has not for the
//   second half.
// - The reverse of both halves together against dual numbers in positions at start and end, velocities of metal and die,
//   displacements and vertices of the die, where nodes and middles of edges arrive at a die with waves.
// - Where nodes stand at the die at the end, some for a part of the half, and where they are farther off by what was
//   expected and by what contact fades over, the last digit of gaps changes nothing.

#include "heat_test_tools.h"

using namespace retroforge;

namespace
{
  constexpr double path = 0.1;

  /// How the block and the die beneath it move [mm/s], and in which time they come nearer by the path.
  struct Motion
  {
    Vec3 metal, die;
    bool known = true;
  };

  /// The parts of an increment's halves for which nodes at a gap touch, which have another one at its end.
  std::array<double, 2>
  parts(const Motion &motion, const double off, const double off_at_end, const double gap = 1e-4)
  {
    Body body(box_mesh(Vec3({1., 1., 1.}), {{2, 2, 2}}), {Die("floor", Vec3(), Vec3({0., 0., 1.}))});
    const NodalVectors<double> velocity(motion.known ? body.mesh.n_nodes() : 0, motion.metal);
    body.states[0].velocity = motion.die;
    const auto at           = [&](const double z) {
      NodalVectors<double> X = body.mesh.X;
      for (Vec3 &x : X)
        x[2] += z;
      return X;
    };
    const auto X = at(off), X_end = at(off_at_end);
    const auto start = thermal_surface<double>(
      {body.mesh, body.topology, body.dies, body.states, X, nullptr, MPI_COMM_SELF, &velocity},
      {true},
      {gap, path});
    const auto end = thermal_surface_after<double>(
      start, {body.mesh, body.topology, body.dies, body.states, X_end}, {true}, gap);
    const auto weight = [](const ThermalSurface<double> &surface) {
      return surface.touching.empty() ? 0. : surface.touching[0].weight;
    };
    return {{weight(start), weight(end)}};
  }

  void check_times()
  {
    const Motion falls{Vec3({0., 0., -2.}), Vec3({0., 0., 0.})}, rests{Vec3(), Vec3({0., 0., 2.})},
      unknown{Vec3(), Vec3({0., 0., 2.}), false}, both{Vec3({0.3, 0., -1.}), Vec3({0., 0., 2.})},
      along{Vec3({5., 0., 0.}), Vec3({1., 0., 0.})}, away{Vec3({0., 0., 2.}), Vec3({0., 0., 1.})};
    // Of dies that do not move nothing tells how fast metal comes but itself: as far as the path says.
    double error = 0.;
    for (const auto &[motion, speed] : {std::make_pair(rests, 1.), {unknown, 1.}, {both, 1.5}, {falls, 1.}})
      for (const double t : {0.05, 0.3, 0.5, 0.77, 0.999, 1.001, 1.4, 1.9})
      {
        // With the path of the increment, the gap at its end and at the next one's.
        const double p = path * speed, off = t * p, next = std::max(0., off - p);
        const auto   in_first = parts(motion, off, next), in_second = parts(motion, next, 0.);
        const double touched = 0.5 * (in_first[0] + in_first[1] + in_second[0] + in_second[1]);
        error                = std::max(error, std::abs(touched - (2. - t)));
      }
    std::cout << "time after arrival off by less than 2e-3 of an increment: " << yes(error < 2e-3) << "\n";
    if (error >= 2e-3)
      std::cout << "  " << error << "\n";
    const auto sum = [](const std::array<double, 2> &of) { return of[0] + of[1]; };
    std::cout << "metal along a die and away from it does not arrive: "
              << yes(sum(parts(along, 0.3 * path, 0.)) == 0.) << ' '
              << yes(sum(parts(away, 0.3 * path, 0.)) == 0.) << "; what has left touched in the first half: "
              << yes(parts(falls, 0., path) == std::array<double, 2>{{1., 0.}}) << "\n";
    // Half as far off as contact fades, metal that rests beside the die touches by half, in both halves.
    const Motion rests_beside{Vec3({0., 0., 1.}), Vec3({0., 0., 1.})};
    const auto   in_part = parts(rests_beside, 0.05, 0.05, 0.1);
    std::cout << "what stands in the gap touches in part: " << yes(std::abs(in_part[0] - 0.5) < 0.02) << ' '
              << yes(std::abs(in_part[1] - 0.5) < 0.02) << "\n";
    // What was expected at half of the gap and is at all of it touches by half of its part.
    const double nearer  = parts(rests, 0.15, 0.1 - 1e-12, 0.1)[1],
                 farther = parts(rests, 0.15, 0.1 + 1e-12, 0.1)[1];
    std::cout << "farther off than fading reaches, as was expected: " << yes(farther > 0.01)
              << ", the last digit changes nothing: " << yes(std::abs(nearer - farther) < 1e-9) << "\n";
  }

  /// Both halves.
  template <typename Number>
  std::array<ThermalSurface<Number>, 2> halves(const Body                          &body,
                                               const std::vector<DieState<Number>> &states,
                                               const std::vector<DieState<Number>> &states_at_end,
                                               const NodalVectors<Number>          &X,
                                               const NodalVectors<Number>          &X_end,
                                               const NodalVectors<Number>          &velocity)
  {
    const auto start = thermal_surface<Number>(
      {body.mesh, body.topology, body.dies, states, X, nullptr, MPI_COMM_SELF, &velocity},
      {true},
      {0.03, path});
    return {{start,
             thermal_surface_after<Number>(
               start, {body.mesh, body.topology, body.dies, states_at_end, X_end}, {true}, 0.03)}};
  }

  /// A shaken box above a die with waves that comes up to it.
  struct OnWaves
  {
    Body                          body;
    std::vector<DieState<double>> states, states_at_end;

    explicit OnWaves(RandomNumbers &numbers)
        : body(box_mesh(Vec3({1.5, 1.5, 0.5}), {{3, 3, 1}}),
               {Die("wave",
                    sheet(16,
                          [](const double x, const double y) {
                            return -0.1 * (x * x + y * y) + 0.03 * std::sin(4. * x + y);
                          }),
                    1.)})
        , states(body.states)
    {
      for (Vec3 &x : body.mesh.X)
        x += Vec3({-0.75, -0.75, 0.04}) + 0.02 * numbers.vector();
      states[0].vertices            = body.dies[0].surface()->vertices();
      states[0].velocity            = Vec3({0.1, 0., 1.});
      states_at_end                 = states;
      states_at_end[0].displacement = Vec3({0.01, 0., path});
    }
  };

  void check_transpose()
  {
    RandomNumbers numbers;
    const OnWaves scene(numbers);
    const auto &[body, states, states_at_end] = scene;
    NodalVectors<double> X = body.mesh.X, X_end = X, velocity = X;
    for (std::size_t k = 0; k < X.size(); ++k)
    {
      X_end[k] += 0.02 * numbers.vector() + Vec3({0., 0., 0.04});
      velocity[k] = Vec3({0., 0., 0.3}) + 0.3 * numbers.vector();
    }
    const auto   surfaces = halves(body, states, states_at_end, X, X_end, velocity);
    unsigned int arriving = 0, edges = 0;
    for (const auto &at : surfaces[0].touching)
      arriving += at.later.part > 0.01 && at.later.part < 0.99;
    for (const auto &edge : surfaces[0].edges)
      edges += edge.later.part > 0.01 && edge.later.part < 0.99;

    const RandomNumbers           first, second;
    ThermalSurfaceBar             start_bar = sum_of_all_bar(surfaces[0], first);
    ThermalSurfaceBar             end_bar   = sum_of_all_bar(surfaces[1], second);
    NodalVectors<double>          X_bar(X.size()), X_end_bar(X.size()), velocity_bar(X.size());
    std::vector<DieState<double>> dies_bar(1), dies_end_bar(1);
    for (auto *bar : {&dies_bar, &dies_end_bar})
      (*bar)[0].vertices.resize(states[0].vertices.size());
    reverse_thermal_surface_after(surfaces[0],
                                  {body.mesh, body.topology, body.dies, states_at_end, X_end},
                                  surfaces[1],
                                  0.03,
                                  end_bar,
                                  start_bar,
                                  X_end_bar,
                                  dies_end_bar);
    reverse_thermal_surface(
      {body.mesh, body.topology, body.dies, states, X, nullptr, MPI_COMM_SELF, &velocity},
      surfaces[0],
      {0.03, path},
      start_bar,
      X_bar,
      dies_bar,
      &velocity_bar);

    std::vector<DieState<Dual>> states_dot(1), states_end_dot(1);
    convert(states, states_dot);
    convert(states_at_end, states_end_dot);
    NodalVectors<Dual>    X_dot(X.size()), X_end_dot(X.size()), velocity_dot(X.size());
    std::array<double, 6> of{};
    for (std::size_t k = 0; k < X.size(); ++k)
    {
      of[0] += varied(X[k], numbers.vector(), X_dot[k]) * X_bar[k];
      of[1] += varied(X_end[k], numbers.vector(), X_end_dot[k]) * X_end_bar[k];
      of[2] += varied(velocity[k], numbers.vector(), velocity_dot[k]) * velocity_bar[k];
    }
    of[3] = varied(states[0].displacement, numbers.vector(), states_dot[0].displacement) *
              dies_bar[0].displacement +
            varied(states_at_end[0].displacement, numbers.vector(), states_end_dot[0].displacement) *
              dies_end_bar[0].displacement;
    of[4] = varied(states[0].velocity, numbers.vector(), states_dot[0].velocity) * dies_bar[0].velocity;
    for (std::size_t v = 0; v < states[0].vertices.size(); ++v)
    {
      const Vec3 dot = varied(states[0].vertices[v], numbers.vector(), states_dot[0].vertices[v]);
      varied(states[0].vertices[v], dot, states_end_dot[0].vertices[v]);
      of[5] += dot * (dies_bar[0].vertices[v] + dies_end_bar[0].vertices[v]);
    }
    const auto   dual    = halves(body, states_dot, states_end_dot, X_dot, X_end_dot, velocity_dot);
    const double forward = (sum_of_all(dual[0], first) + sum_of_all(dual[1], second)).dx(0);
    double       reverse = 0.;
    for (const double part : of)
      reverse += part;
    std::cout << "nodes and edges that arrive: " << yes(arriving > 3) << ' ' << yes(edges > 5)
              << "; transpose within 1e-12: " << yes(std::abs(forward / reverse - 1.) < 1e-12)
              << ", by positions at start and end, velocities of metal, displacements, velocity of the die, "
                 "vertices:";
    for (const double part : of)
      std::cout << ' ' << yes(std::abs(part / reverse) > 1e-3);
    std::cout << "\n";
  }

  /// What the second half makes of nodes that are moved by a little along the die's normal.
  void check_rounding()
  {
    constexpr double gap = 0.03;
    RandomNumbers    numbers;
    const OnWaves    scene(numbers);
    const auto &[body, states, states_at_end] = scene;
    const NodalVectors<double> &X             = body.mesh.X, velocity(X.size(), Vec3({0., 0., 0.3}));
    const auto                  begins        = halves(body, states, states_at_end, X, X, velocity)[0];
    const auto                 &die           = body.dies[0];
    unsigned int                stand         = 0;
    const auto                  moved         = [&](const double by) {
      NodalVectors<double> X_end = X;
      stand                      = 0;
      for (const auto &at : begins.touching)
      {
        for (unsigned int i = 0; i < 20; ++i)
        {
          const auto feature = die.closest(X_end[at.node], states_at_end[0].displacement, 0.3);
          if (!feature.found())
            break;
          const auto sees = die.project(X_end[at.node], states_at_end[0], feature);
          X_end[at.node] -= (by - sees.delta) * sees.n;
        }
        ++stand;
      }
      // Areas that touch and that are free: what is listed without one may change.
      const auto          ends  = halves(body, states, states_at_end, X, X_end, velocity)[1];
      std::vector<double> areas = ends.free;
      areas.resize(2 * areas.size(), 0.);
      for (const auto &at : ends.touching)
        areas[X.size() + at.node] += at.area;
      return areas;
    };
    const auto on = moved(1e-12), in = moved(-1e-12);
    double     off = 0.;
    for (std::size_t i = 0; i < on.size(); ++i)
      off = std::max(off, std::abs(on[i] - in[i]));
    std::cout << "nodes that stand at the die: " << yes(stand > 10)
              << "; the last digit changes nothing: " << yes(off < 1e-9) << "\n";
    if (off >= 1e-9)
      std::cout << "  " << off << "\n";
  }
} // namespace

int main()
{
  check_times();
  check_transpose();
  check_rounding();
}
