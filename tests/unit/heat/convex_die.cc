// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// What touches a die that bulges into the edges of a flat surface: its nodes stand off it by far more than the gap across which
// contact fades.
// - A square of nodes over the summit of a dome, 0.03 off it as its sides are, whose middles touch: it touches, and nothing else
//   does. With the dome lower by twice the gap nothing touches; on a flat die, which bulges into nothing, neither, where nodes
//   are 0.03 off it.
// - The reverse against dual numbers in positions, displacement and vertices of the die.

#include "heat_test_tools.h"

using namespace retroforge;

namespace
{
  constexpr double radius = 1., size = 0.5, gap = 0.01;

  double dome(const double x, const double y)
  {
    return -(x * x + y * y) / (2. * radius);
  }

  /// Three squares of `size` along x and y, their middle at the origin, their bottom at z.
  Body body_over(std::vector<Die> dies, const double z)
  {
    Body body(box_mesh(Vec3({3. * size, 3. * size, 0.5}), {{3, 3, 1}}), std::move(dies));
    for (Vec3 &x : body.mesh.X)
      x += Vec3({-1.5 * size, -1.5 * size, z});
    for (std::size_t d = 0; d < body.dies.size(); ++d)
      if (body.dies[d].surface())
        body.states[d].vertices = body.dies[d].surface()->vertices();
    return body;
  }

  double touching_area(const Body &body)
  {
    double area = 0.;
    for (const auto &at : body.surface(body.states, body.mesh.X, gap).touching)
      area += at.area;
    return area;
  }

  void check_values()
  {
    // Of the middles of the square's sides.
    const double side = dome(0.5 * size, 0.), off = side - dome(0.5 * size, 0.5 * size);
    const auto   of = [&](const Die &die, const double z) { return touching_area(body_over({die}, z)); };
    const Die ball("ball", sheet(64, dome), 1.), flat("flat", Vec3({0., 0., side - off}), Vec3({0., 0., 1.}));
    const double touches = of(ball, side);
    std::cout << "nodes are off by " << off / gap
              << " gaps; the square touches: " << yes(std::abs(touches / (size * size) - 1.) < 1e-3)
              << ", not from two gaps away: " << yes(of(ball, side + 2. * gap) == 0.)
              << ", nor a flat die as far from the nodes: " << yes(of(flat, side) == 0.) << "\n";
  }

  void check_transpose()
  {
    RandomNumbers numbers;
    const auto    wave = [](const double x, const double y) {
      return 0.5 * dome(x, y) + 0.05 * std::sin(4. * x + y);
    };
    Body body = body_over({Die("wave", sheet(16, wave), 1.)}, 0.02);
    for (Vec3 &x : body.mesh.X)
      x += 0.02 * numbers.vector();
    constexpr double wide    = 0.05;
    const auto       surface = body.surface(body.states, body.mesh.X, wide);
    unsigned int     raised = 0, in_part = 0;
    for (const auto &edge : surface.edges)
      for (const unsigned int end : edge.ends)
      {
        const auto  &at    = surface.touching[end];
        const double delta = body.dies[0].project(body.mesh.X[at.node], body.states[0], at.feature).delta;
        raised += delta > wide && at.weight > 0.01;
        in_part += at.weight > 0.01 && at.weight < 0.99;
      }
    const RandomNumbers           weights;
    const ThermalSurfaceBar       bar = sum_of_all_bar(surface, weights);
    NodalVectors<double>          X_bar(body.mesh.n_nodes());
    std::vector<DieState<double>> dies_bar(1);
    dies_bar[0].vertices.resize(body.states[0].vertices.size());
    reverse_thermal_surface(
      {body.mesh, body.topology, body.dies, body.states, body.mesh.X}, surface, wide, bar, X_bar, dies_bar);
    NodalVectors<Dual>          X(body.mesh.n_nodes());
    std::vector<DieState<Dual>> states(1);
    convert(body.states, states);
    double     of_X = 0., of_die = 0., of_vertices = 0.;
    const auto vary = [&](const Vec3 &x, const Vec3 &x_bar, Vector3<Dual> &to, double &sum) {
      sum += varied(x, numbers.vector(), to) * x_bar;
    };
    for (std::size_t k = 0; k < X.size(); ++k)
      vary(body.mesh.X[k], X_bar[k], X[k], of_X);
    vary(body.states[0].displacement, dies_bar[0].displacement, states[0].displacement, of_die);
    for (std::size_t v = 0; v < states[0].vertices.size(); ++v)
      vary(body.states[0].vertices[v], dies_bar[0].vertices[v], states[0].vertices[v], of_vertices);
    const double forward = sum_of_all(body.surface(states, X, wide), weights).dx(0),
                 reverse = of_X + of_die + of_vertices;
    const auto counts    = [&](const double part) { return yes(std::abs(part / reverse) > 1e-3); };
    std::cout << "ends beyond the gap that touch, others in part: " << yes(raised > 2) << ' '
              << yes(in_part > 2)
              << "; transpose within 1e-12: " << yes(std::abs(forward / reverse - 1.) < 1e-12)
              << ", by positions, displacement, vertices: " << counts(of_X) << ' ' << counts(of_die) << ' '
              << counts(of_vertices) << "\n";
  }
} // namespace

int main()
{
  check_values();
  check_transpose();
}
