// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Derivatives of a step of conduction on a shaken box between two dies that it touches in part, that radiates, with
// skins, at limited temperatures: steps short and long.
// - <A x_dot, y> = <x_dot, A^T y>, A from dual numbers, by positions, displacements and temperatures of the dies, the
//   numbers of heat, time, temperatures and skins, each alone and all together;
// - the remainder of Taylor's expansion falls with the square of the step;
// - every term of the reverse is needed: without any one of those below, derivatives are off by more than 1e-6.

#include "heat_test_tools.h"

#include <cmath>
#include <functional>

using namespace retroforge;

namespace
{
  /// All that a step depends on, and what it makes.
  template <typename Number>
  struct State
  {
    NodalVectors<Number>          X;
    std::vector<DieState<Number>> dies;
    HeatLaw<Number>               law;
    Number                        dt;
    std::vector<Number>           T;
    NodeSkins<Number>             skin;
    std::vector<Number>           friction;

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[X, dies, law, dt, T, skin, friction] = self;
      return std::tie(X, dies, law, dt, T, skin, friction);
    }
  };

  const Vec3 size({10., 10., 6.});

  template <typename Number>
  State<Number> after(const Body &body, const double gap, State<Number> s)
  {
    const auto network = conduction_network(body.mesh, body.edges, s.X);
    const auto surface = body.surface(s.dies, s.X, gap);
    conduct<Number>(
      {body.edges, network, surface, s.law, s.law.contact_film, s.dies, &s.friction}, s.dt, s.T, s.skin);
    return s;
  }

  /// What a reverse may leave out: terms(...) sets it to zero.
  struct Omission
  {
    std::string                                                                            name;
    std::function<void(ConductionNetwork<double> &, ThermalSurfaceBar &, State<double> &)> leave_out;
  };

  template <typename Value>
  void vanish(std::vector<Value> &bar)
  {
    bar.assign(bar.size(), Value());
  }

  const std::vector<Omission> omissions{
    {"volumes", [](auto &network, auto &, auto &) { vanish(network.volumes); }},
    {"conductances", [](auto &network, auto &, auto &) { vanish(network.conductances); }},
    {"bounded conductances", [](auto &network, auto &, auto &) { vanish(network.bounded); }},
    {"weights of contact", [](auto &, auto &surface, auto &) { vanish(surface.weight); }},
    {"areas of contact", [](auto &, auto &surface, auto &) { vanish(surface.touching_area); }},
    {"free areas", [](auto &, auto &surface, auto &) { vanish(surface.free); }},
    {"temperatures of dies",
     [](auto &, auto &, auto &bar) {
       for (auto &die : bar.dies)
         die.temperature = 0.;
     }},
    {"skins of the metal", [](auto &, auto &, auto &bar) { vanish(bar.skin.metal); }},
    {"skins of a die", [](auto &, auto &, auto &bar) { vanish(bar.skin.dies[0]); }},
    {"friction", [](auto &, auto &, auto &bar) { vanish(bar.friction); }},
    {"time", [](auto &, auto &, auto &bar) { bar.dt = 0.; }}};

  /// Derivatives of  T_bar·T + skin_bar·skin  after the step.
  State<double> reversed(const Body          &body,
                         const double         gap,
                         const State<double> &s,
                         State<double>        bar,
                         const Omission      *omitted = nullptr)
  {
    const auto                network = conduction_network(body.mesh, body.edges, s.X);
    const auto                surface = body.surface(s.dies, s.X, gap);
    ThermalSurfaceBar         surface_bar(surface);
    ConductionNetwork<double> network_bar = no_derivatives(network);
    HeatFlowBar               flow_bar{
      network_bar, surface_bar, bar.law, bar.law.contact_film, bar.dies, bar.dt, &bar.friction};
    reverse_conduct({body.edges, network, surface, s.law, s.law.contact_film, s.dies, &s.friction},
                    s.dt,
                    s.T,
                    s.skin,
                    bar.T,
                    bar.skin,
                    flow_bar);
    if (omitted)
      omitted->leave_out(network_bar, surface_bar, bar);
    reverse_thermal_surface(
      {body.mesh, body.topology, body.dies, s.dies, s.X}, surface, gap, surface_bar, bar.X, bar.dies);
    reverse_conduction_network(body.mesh, body.edges, s.X, network_bar, bar.X);
    return bar;
  }

  double dot(const State<double> &a, const State<double> &b)
  {
    double sum = 0.;
    for_each_number([&](const double x, const double y) { sum += x * y; }, a, b);
    return sum;
  }

  /// The kinds of arguments: a member of State.
  const std::vector<std::string>
    kinds{"positions", "dies", "numbers of heat", "time", "temperatures", "skins", "friction"};

  State<double> direction(const State<double> &s, const int kind, RandomNumbers &numbers)
  {
    State<double> dot = s;
    for_each_number([](double &x) { x = 0.; }, dot);
    const auto is = [&](const int k) { return kind < 0 || kind == k; };
    if (is(0))
      for (Vec3 &x : dot.X)
        x = 0.1 * numbers.vector();
    if (is(1))
      for (auto &die : dot.dies)
      {
        die.displacement = 0.02 * numbers.vector();
        die.temperature  = 100. * numbers.scalar();
      }
    if (is(2))
    {
      const auto info = s.law.info();
      for (unsigned int i = 0; i < info.size(); ++i)
      {
        auto law              = s.law;
        number_of(dot.law, i) = number_of(law, i) * numbers.scalar();
      }
    }
    if (is(3))
      dot.dt = s.dt * numbers.scalar();
    if (is(4))
      for (double &x : dot.T)
        x = 30. * numbers.scalar();
    if (is(5))
      for_each_number([&](double &x) { x = 25. * numbers.scalar(); }, dot.skin);
    if (is(6))
      for (double &x : dot.friction)
        x = 1000. * numbers.scalar();
    return dot;
  }

  /// @param colder  the metal, so that the temperature behind films is at the ends of its range [K]
  void check(const double dt, const double colder = 0.)
  {
    RandomNumbers    numbers;
    constexpr double gap = 0.4;
    Body             body(box_mesh(size, {{4, 4, 3}}),
              {Die("lower", Vec3(), Vec3({0., 0., 1.})), Die("upper", size, Vec3({0., 0., -1.}))});
    State<double>    s;
    s.X = body.mesh.X;
    for (Vec3 &x : s.X)
      x += Vec3({0.5 * numbers.scalar(), 0.5 * numbers.scalar(), 0.15 * numbers.scalar()});
    s.dies                = body.states;
    s.dies[0].temperature = 150.;
    s.dies[1].temperature = 300.;
    s.law                 = steel();
    s.law.contact_film    = 12.;
    s.law.air_film        = 0.05;
    s.law.emissivity      = 0.9;
    s.dt                  = dt;
    for (NodeIndex k = 0; k < s.X.size(); ++k)
    {
      s.T.push_back((s.X[k][0] < 5. ? 900. : 1200.) - colder);
      s.T.back() += 5. * numbers.scalar();
    }
    s.skin = NodeSkins<double>::none(s.X.size(), 2);
    for_each_number([&](double &x) { x = 30. + 25. * numbers.scalar(); }, s.skin);
    for (NodeIndex k = 0; k < s.X.size(); ++k)
      s.friction.push_back(2000. + 1000. * numbers.scalar());
    State<double> bar = s;
    for_each_number([](double &x) { x = 0.; }, bar);
    bar.T = numbers.scalars(s.T.size());
    for_each_number([&](double &x) { x = numbers.scalar(); }, bar.skin);
    const State<double> weights = bar, gradient = reversed(body, gap, s, bar);
    const auto          nominal = after(body, gap, s);
    for (const Omission &omission : omissions)
    {
      const State<double> x_dot = direction(s, -1, numbers);
      const double whole = dot(gradient, x_dot), off = dot(reversed(body, gap, s, bar, &omission), x_dot);
      std::cout << dt << " s, without " << omission.name
                << ": seen: " << yes(std::abs(off - whole) > 1e-6 * std::abs(whole)) << "\n";
    }
    for (int kind = -1; kind < int(kinds.size()); ++kind)
    {
      const State<double> x_dot = direction(s, kind, numbers);
      State<Dual>         dual;
      convert(s, dual);
      for_each_number([](Dual &x, const double d) { x.fastAccessDx(0) = d; }, dual, x_dot);
      const auto end     = after(body, gap, dual);
      double     tangent = 0.;
      for (NodeIndex k = 0; k < end.T.size(); ++k)
        tangent += weights.T[k] * end.T[k].dx(0);
      for_each_number(
        [&](const double weight, const Dual &x) { tangent += weight * x.dx(0); }, weights.skin, end.skin);
      const double adjoint = dot(gradient, x_dot);
      // Of all temperatures and skins: in a sum of them terms of second order may nearly cancel.
      const auto remainder = [&](const double t) {
        State<double> moved = s;
        for_each_number([t](double &x, const double d) { x += t * d; }, moved, x_dot);
        const auto there = after(body, gap, moved);
        double     sum   = 0.;
        for (NodeIndex k = 0; k < there.T.size(); ++k)
          sum += std::pow(there.T[k] - nominal.T[k] - t * end.T[k].dx(0), 2);
        for_each_number([&](const double moved,
                            const double from,
                            const Dual  &x) { sum += std::pow(moved - from - t * x.dx(0), 2); },
                        there.skin,
                        nominal.skin,
                        end.skin);
        return std::sqrt(sum);
      };
      double order = 0.;
      for (const double h : {1e-2, 1e-3, 1e-4})
      {
        const double found = std::log2(remainder(h) / remainder(0.5 * h));
        if (std::abs(found - 2.) < std::abs(order - 2.))
          order = found;
      }
      const bool linear = remainder(1e-2) < 1e-12 * std::sqrt(double(s.T.size())) * 1000.;
      double squares = 0.; // what a sum of these terms with random signs is like: it may be small by chance
      for_each_number([&](const double g, const double d) { squares += g * d * g * d; }, gradient, x_dot);
      const double error = std::abs(tangent - adjoint) / std::max(std::sqrt(squares), 1e-300);
      std::cout << dt << " s, " << (kind < 0 ? "all" : kinds[kind])
                << ": direct method within 1e-11: " << yes(error < 1e-11)
                << ", remainder of second order, or none: " << yes(linear || std::abs(order - 2.) < 0.1)
                << "\n";
      if (error >= 1e-11 || !(linear || std::abs(order - 2.) < 0.1))
        std::cout << "  " << error << ' ' << order << ' ' << remainder(1e-2) << ' ' << adjoint << ' '
                  << squares << "\n";
    }
  }
} // namespace

int main()
{
  for (const double dt : {1e-3, 0.05, 2.})
    check(dt);
  std::cout << "metal near the temperatures of dies\n";
  check(0.05, 800.);
}
