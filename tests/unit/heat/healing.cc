// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Skins of a workpiece that waits.
// - A skin that a film makes has the age of the contact: e' = e t/(t + 2 time) for t = 0.2 s; after no time it is itself,
//   after a long one none; derivatives against differences.
// - On a shaken box that touches a die in part: <A x_dot, y> = <x_dot, A^T y>, A from dual numbers, by weights, numbers of
//   heat, time and skins.
// - A half space of steel that touches a die for a time t, is in air for another, and touches a die again: heat that the
//   second contact takes, on elements of 4 mm, beside fine finite differences in one dimension; within 10 %, where a skin that stays as
//   it was takes up to 24 % less.

#include <retroforge/heat/healing.h>
#include <retroforge/heat/skin.h>

#include "heat_test_tools.h"

using namespace retroforge;

namespace
{
  void check_skin()
  {
    const double h = 10., b = 5.4, time = 0.7;
    const double e   = skin_step(0., h, b * b, 0.2).e;
    const auto   end = healed_skin(e, h, b * b, time);
    std::cout << "of the age of its contact: "
              << yes(std::abs(end.e / (e * 0.2 / (0.2 + 2. * time)) - 1.) < 1e-12)
              << ", at once: " << yes(std::abs(healed_skin(e, h, b * b, 1e-13).e / e - 1.) < 1e-11)
              << ", in the end: " << yes(healed_skin(e, h, b * b, 1e9).e < 1e-9 * e) << "\n";
    const std::array<double, 4> x{{e, h, b * b, time}}, slopes{{end.e_e, end.e_h, end.e_b2, end.e_time}};
    double                      worst = 0.;
    for (unsigned int i = 0; i < 4; ++i)
    {
      const auto at = [&](const double t) {
        auto y = x;
        y[i] *= 1. + t;
        return healed_skin(y[0], y[1], y[2], y[3]).e;
      };
      worst = std::max(worst, std::abs((at(1e-5) - at(-1e-5)) / (2e-5 * x[i]) / slopes[i] - 1.));
    }
    std::cout << "derivatives within 1e-8: " << yes(worst < 1e-8) << "\n";
  }

  /// All that skins heal by.
  template <typename Number>
  struct State
  {
    std::vector<Number> weights, skin;
    HeatLaw<Number>     law;
    Number              time;

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[weights, skin, law, time] = self;
      return std::tie(weights, skin, law, time);
    }
  };

  template <typename Number>
  ThermalSurface<Number> with_weights(const ThermalSurface<double> &surface,
                                      const std::vector<Number>    &weights)
  {
    ThermalSurface<Number> made;
    for (std::size_t i = 0; i < weights.size(); ++i)
      made.touching.push_back(
        {surface.touching[i].node, surface.touching[i].die, surface.touching[i].feature, weights[i]});
    made.free.resize(surface.free.size());
    return made;
  }

  void check_transpose()
  {
    RandomNumbers numbers;
    Body body(box_mesh(Vec3({10., 10., 6.}), {{3, 3, 2}}), {Die("lower", Vec3(), Vec3({0., 0., 1.}))});
    for (Vec3 &x : body.mesh.X)
      x += 0.2 * numbers.vector();
    const auto    surface = body.surface(body.states, body.mesh.X, 0.3);
    State<double> s{{}, std::vector<double>(body.mesh.n_nodes()), steel(), 0.6};
    s.law.contact_film   = 12.;
    unsigned int in_part = 0;
    for (const auto &at : surface.touching)
    {
      s.weights.push_back(at.weight);
      in_part += at.weight > 0.01 && at.weight < 0.99 ? 1 : 0;
    }
    for (double &e : s.skin)
      e = 1. + numbers.scalar();
    State<double> bar = s;
    for_each_number([](double &x) { x = 0.; }, bar);
    for (double &e : bar.skin)
      e = numbers.scalar();
    const std::vector<double> y = bar.skin;
    ThermalSurfaceBar         surface_bar(surface);
    reverse_heal_skins(surface, s.law, s.time, s.skin, bar.skin, {surface_bar, bar.law, bar.time});
    bar.weights         = surface_bar.weight;
    State<double> x_dot = s;
    for_each_number([&](double &x) { x *= numbers.scalar(); }, x_dot);
    State<Dual> at;
    convert(s, at);
    for_each_number([](Dual &x, const double dot) { x.fastAccessDx(0) = dot; }, at, x_dot);
    heal_skins(with_weights(surface, at.weights), at.law, at.time, at.skin);
    double forward = 0., reverse = 0.;
    for (std::size_t k = 0; k < y.size(); ++k)
      forward += y[k] * at.skin[k].dx(0);
    for_each_number([&](const double a, const double b) { reverse += a * b; }, x_dot, bar);
    // Each kind of argument counts: left out, the transpose would be seen to fail.
    const auto part = [&](const auto &dot, const auto &of) {
      double sum = 0.;
      for_each_number([&](const double a, const double b) { sum += a * b; }, dot, of);
      return std::abs(sum / reverse) > 1e-6;
    };
    std::cout << "touched in part: " << yes(in_part > 2)
              << ", transpose within 1e-12: " << yes(std::abs(forward / reverse - 1.) < 1e-12)
              << ", by weights, skins, numbers, time: " << yes(part(x_dot.weights, bar.weights)) << ' '
              << yes(part(x_dot.skin, bar.skin)) << ' ' << yes(part(x_dot.law, bar.law)) << ' '
              << yes(part(x_dot.time, bar.time)) << "\n";
  }

  constexpr double T_0 = 1200., T_d = 200., b_d = 10.;

  /// Steel and die as two half spaces in one dimension, on a grid that grows from 0.01 mm: heat that passes in each spell.
  class Reference
  {
  public:
    explicit Reference(const HeatLaw<double> &law)
        : k_(law.conductivity)
        , metal_(law.capacity)
        , die_(b_d * b_d / law.conductivity)
        , x_(2 * n, 0.)
        , T_(2 * n)
    {
      for (unsigned int i = 0; i < 2 * n; ++i)
      {
        x_[i] = 0.01 * std::pow(1.025, i < n ? n - 1 - i : i - n);
        T_[i] = i < n ? T_d : T_0;
      }
    }

    /// @param h  of the film between them
    double pass(const double h, const double time)
    {
      constexpr unsigned int steps  = 100;
      const double           before = heat();
      for (unsigned int s = 0; s < steps; ++s)
        step(h, time * (2. * s + 1.) / (double(steps) * steps));
      return before - heat();
    }

  private:
    double heat() const
    {
      double sum = 0.;
      for (unsigned int i = n; i < 2 * n; ++i)
        sum += metal_ * x_[i] * T_[i];
      return sum;
    }

    void step(const double h, const double dt)
    {
      std::vector<double> g(2 * n - 1), D(2 * n), rhs(2 * n);
      for (unsigned int i = 0; i + 1 < 2 * n; ++i)
      {
        const double drop = 0.5 * (x_[i] + x_[i + 1]) / k_;
        g[i]              = i + 1 != n ? 1. / drop : h > 0. ? 1. / (drop + 1. / h) : 0.;
      }
      for (unsigned int i = 0; i < 2 * n; ++i)
      {
        const double C = (i < n ? die_ : metal_) * x_[i] / dt;
        D[i]           = C + (i > 0 ? g[i - 1] : 0.) + (i + 1 < 2 * n ? g[i] : 0.);
        rhs[i]         = C * T_[i];
      }
      for (unsigned int i = 1; i < 2 * n; ++i)
      {
        const double m = g[i - 1] / D[i - 1];
        D[i] -= m * g[i - 1];
        rhs[i] += m * rhs[i - 1];
      }
      for (unsigned int i = 2 * n; i-- > 0;)
        T_[i] = (rhs[i] + (i + 1 < 2 * n ? g[i] * T_[i + 1] : 0.)) / D[i];
    }

    static constexpr unsigned int n = 300;
    double                        k_, metal_, die_;
    std::vector<double>           x_, T_;
  };

  /// Heat that the second contact takes from a block, over that of the reference, less 1.
  double second_contact(const double h, const double touches, const double waits, const bool heals)
  {
    constexpr double element = 4.;
    Body             body(box_mesh(Vec3({4. * element, 4. * element, 40.}), {{4, 4, 10}}),
              {Die("lower", Vec3(), Vec3({0., 0., 1.}))});
    body.states[0].temperature = T_d;
    HeatLaw<double> law        = steel();
    law.die_effusivity         = b_d;
    law.contact_film           = h;
    std::vector<double> T(body.mesh.n_nodes(), T_0), skin(T.size(), 0.);
    body.conduct(law, body.mesh.X, touches, 10, T, skin);
    const auto network = conduction_network(body.mesh, body.edges, body.mesh.X);
    const auto alone   = thermal_surface<double>(
      {body.mesh, body.topology, body.dies, body.states, body.mesh.X}, {false}, law.gap);
    if (heals)
      heal_skins(alone, law, waits, skin);
    for (unsigned int i = 0; i < 10; ++i)
      conduct<double>({body.edges, network, alone, law, law.contact_film, body.states}, waits / 10., T, skin);
    const double in = body.conduct(law, body.mesh.X, touches, 10, T, skin) / (16. * element * element);
    Reference    fine(law);
    fine.pass(h, touches);
    fine.pass(0., waits);
    return -in / fine.pass(h, touches) - 1.;
  }
} // namespace

int main()
{
  check_skin();
  check_transpose();
  double healed = 0., kept = 0.;
  for (const double h : {5., 10., 20.})
    for (const double touches : {0.1, 0.5})
      for (const double waits : {0.5, 3.})
      {
        const double with    = second_contact(h, touches, waits, true),
                     without = second_contact(h, touches, waits, false);
        std::cout << "film " << h << ", " << touches << " s on a die, " << waits
                  << " s in air, again: heat off by " << std::round(100. * with) << " %, without healing "
                  << std::round(100. * without) << "\n";
        healed = std::max(healed, std::abs(with));
        kept   = std::max(kept, std::abs(without));
      }
  std::cout << "within 10 %: " << yes(healed < 0.1) << ", needed: " << yes(kept > 0.2) << "\n";
}
