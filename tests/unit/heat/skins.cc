// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Skins, the layers that contacts have chilled.
// - Beneath films of 0.5 to 100 kW/(m² K), from 1.5 ms to 200 s, 1 - sum m is exp(x²) erfc(x), x = h sqrt(t)/b, within 0.6 %.
// - Steps are exact: one is two halves, the mean is that of both; after no time a skin is itself.
// - Derivatives of steps in rate and time against differences, also of times so short that closed forms cancel;
//   <carried(x), y> = <x, reverse_carried(y)>; dual numbers are all of them together.
// - Out of contact, each mode falls by its rate; slopes of that, and of its mean, against differences.
// - A half space of steel that touches a die for a time t, is in air for another, and touches a die again: heat that the
//   second contact takes, on elements of 4 mm, beside fine finite differences in one dimension; within 3 %, where skins that stay as
//   they were take up to 24 % less.

#include "fine_layers.h"
#include "heat_test_tools.h"

using namespace retroforge;

namespace
{
  void check_film()
  {
    constexpr double b     = 11.8;
    double           worst = 0.;
    for (const double h : {0.5, 2., 5., 10., 20., 50., 100.})
    {
      const SkinsBeneathFilm film(h / b);
      for (int i = 0; i <= 40; ++i)
      {
        const double t = 1.5e-3 * std::pow(200. / 1.5e-3, i / 40.), x = h * std::sqrt(t) / b;
        // exp(x²) erfc(x), of large x by its continued fraction.
        double exact = x;
        for (int n = 60; n > 0; --n)
          exact = x + 0.5 * n / exact;
        exact = x < 2. ? std::exp(x * x) * std::erfc(x) : 1. / (std::sqrt(M_PI) * exact);
        worst = std::max(worst, std::abs(1. - drop_of(SkinPropagator(film, t).source().after) - exact));
      }
    }
    std::cout << "beside erfc within 0.6 %: " << yes(worst < 0.006)
              << ", worst [%]: " << std::round(1e4 * worst) / 100. << "\n";
  }

  Skin<double> some_skin(RandomNumbers &numbers)
  {
    Skin<double> m;
    for (unsigned int j = 0; j < n_skin_modes; ++j)
      m[j] = 0.08 * (1. + numbers.scalar());
    return m;
  }

  void check_steps()
  {
    RandomNumbers numbers;
    double        halves = 0., slopes = 0., transpose = 0., duals = 0., short_time = 0.;
    for (const double rate : {0.05, 0.8, 8.})
      for (const double time : {1e-3, 0.07, 5.})
      {
        const SkinsBeneathFilm film(rate);
        const Skin<double>     m = some_skin(numbers);
        const SkinPropagator   over(film, time), half(film, 0.5 * time);
        const auto             whole_of = [&](const SkinPropagator &beneath, const Skin<double> &skin) {
          const auto carried = beneath.carried(skin);
          return SkinStep<double>{carried.after + beneath.source().after,
                                  carried.mean + beneath.source().mean};
        };
        const auto step = whole_of(over, m), first = whole_of(half, m), second = whole_of(half, first.after);
        halves                = std::max({halves,
                                          (step.after - second.after).norm(),
                                          (step.mean - 0.5 * (first.mean + second.mean)).norm()});
        const auto difference = [&](const double by_rate, const double by_time) {
          constexpr double t  = 1e-4;
          const auto       at = [&](const double rate, const double time) {
            const SkinsBeneathFilm film(rate);
            return whole_of(SkinPropagator(film, time), m);
          };
          const auto up   = at(rate * (1. + t * by_rate), time * (1. + t * by_time)),
                     down = at(rate * (1. - t * by_rate), time * (1. - t * by_time));
          return SkinStep<double>{(up.after - down.after) / (2. * t), (up.mean - down.mean) / (2. * t)};
        };
        const auto slopes_of = [&](const SkinPropagator &beneath) {
          auto slopes = beneath.carried_slopes(m);
          for (const int way : {0, 1})
          {
            slopes[way].after += beneath.source_slopes()[way].after;
            slopes[way].mean += beneath.source_slopes()[way].mean;
          }
          return slopes;
        };
        const auto exact = slopes_of(over);
        for (const int way : {0, 1})
        {
          const auto   found = difference(way == 0, way == 1);
          const double scale = way == 0 ? rate : time;
          slopes             = std::max({slopes,
                                         (found.after - scale * exact[way].after).norm(),
                                         (found.mean - scale * exact[way].mean).norm()});
        }
        const Skin<double>     x = some_skin(numbers);
        const SkinStep<double> y{some_skin(numbers), some_skin(numbers)}, Ax = over.carried(x);
        const double           forward = Ax.after * y.after + Ax.mean * y.mean;
        transpose = std::max(transpose, std::abs(over.reverse_carried(y) * x / forward - 1.));
        // All on dual numbers.
        Skin<Dual> dual;
        for (unsigned int j = 0; j < n_skin_modes; ++j)
        {
          dual[j]                 = Dual(m[j]);
          dual[j].fastAccessDx(0) = x[j];
        }
        Dual dual_rate(rate), dual_time(time);
        dual_rate.fastAccessDx(0)  = 0.3;
        dual_time.fastAccessDx(0)  = -0.2;
        const auto           parts = skin_parts(over, dual_rate, dual, dual_time);
        const SkinStep<Dual> whole{parts.carried.after + parts.source.after,
                                   parts.carried.mean + parts.source.mean};
        for (unsigned int j = 0; j < n_skin_modes; ++j)
        {
          const double after = Ax.after[j] + 0.3 * exact[0].after[j] - 0.2 * exact[1].after[j],
                       mean  = Ax.mean[j] + 0.3 * exact[0].mean[j] - 0.2 * exact[1].mean[j];
          duals              = std::max(
            {duals,
                          std::abs(whole.after[j].val() - step.after[j]) + std::abs(whole.mean[j].val() - step.mean[j]),
                          std::abs(whole.after[j].dx(0) - after) + std::abs(whole.mean[j].dx(0) - mean)});
        }
        // m + t m' + t²/2 m'':  the derivatives in time at once, and in rate over the time.
        constexpr double tiny = 1e-9;
        const auto       at   = slopes_of(SkinPropagator(film, tiny));
        for (unsigned int j = 0; j < n_skin_modes; ++j)
        {
          const double source = skin_weights[j] * (1. - drop_of(m)),
                       slope  = -skin_rates[j] * m[j] + rate * source;
          short_time          = std::max({short_time,
                                          std::abs(at[1].after[j] / slope - 1.),
                                          std::abs(at[1].mean[j] / (0.5 * slope) - 1.),
                                          std::abs(at[0].after[j] / (tiny * source) - 1.),
                                          std::abs(at[0].mean[j] / (0.5 * tiny * source) - 1.)});
        }
      }
    std::cout << "two halves within 1e-13: " << yes(halves < 1e-13)
              << ", slopes within 1e-7: " << yes(slopes < 1e-7)
              << ", of short times within 1e-5: " << yes(short_time < 1e-5)
              << ", transpose within 1e-13: " << yes(transpose < 1e-13)
              << ", dual numbers: " << yes(duals < 1e-14) << "\n";
    if (halves >= 1e-13 || slopes >= 1e-7 || short_time >= 1e-5 || transpose >= 1e-13 || duals >= 1e-14)
      std::cout << halves << ' ' << slopes << ' ' << short_time << ' ' << transpose << ' ' << duals << "\n";
    const Skin<double>     m = some_skin(numbers), later = healed(m, healing(0.3).after);
    const SkinsBeneathFilm film(2.);
    double                 off = (SkinPropagator(film, 0.).carried(m).after - m).norm() +
                 (healed(m, healing(0.).after) - m).norm() + (healed(m, healing(0.).mean) - m).norm();
    for (unsigned int j = 0; j < n_skin_modes; ++j)
      off += std::abs(later[j] - m[j] * std::exp(-0.3 * skin_rates[j]));
    std::cout << "itself after no time, and out of contact each by its rate: " << yes(off < 1e-14) << "\n";
    double slope_off = 0.;
    for (const double time : {1e-5, 0.02, 3.})
    {
      const auto up = healing(1.0001 * time), down = healing(0.9999 * time), slope = slope_of_healing(time);
      slope_off = std::max({slope_off,
                            (up.after - down.after - 2e-4 * time * slope.after).norm() / 2e-4,
                            (up.mean - down.mean - 2e-4 * time * slope.mean).norm() / 2e-4});
    }
    std::cout << "slopes of that within 1e-8: " << yes(slope_off < 1e-8) << "\n";
  }

  constexpr double T_0 = 1200., T_d = 200., b_d = 10.;

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
    std::vector<double> T(body.mesh.n_nodes(), T_0);
    NodeSkins<double>   skin = body.no_skins();
    body.conduct(law, body.mesh.X, touches, 10, T, skin);
    const auto network = conduction_network(body.mesh, body.edges, body.mesh.X);
    const auto alone   = thermal_surface<double>(
      {body.mesh, body.topology, body.dies, body.states, body.mesh.X}, {false}, law.gap);
    const auto kept = skin;
    for (unsigned int i = 0; i < 10; ++i)
      conduct<double>({body.edges, network, alone, law, law.contact_film, body.states}, waits / 10., T, skin);
    if (!heals)
      skin = kept;
    const double in = body.conduct(law, body.mesh.X, touches, 10, T, skin) / (16. * element * element);
    FineLayers   fine(law, T_0, T_d);
    fine.pass(h, touches);
    fine.pass(0., waits);
    return -in / fine.pass(h, touches) - 1.;
  }
} // namespace

int main()
{
  check_film();
  check_steps();
  double off = 0., kept = 0.;
  for (const double h : {5., 10., 20.})
    for (const double touches : {0.1, 0.5})
      for (const double waits : {0.5, 3.})
      {
        const double with    = second_contact(h, touches, waits, true),
                     without = second_contact(h, touches, waits, false);
        std::cout << "film " << h << ", " << touches << " s on a die, " << waits
                  << " s in air, again: heat off by " << std::round(1000. * with) / 10.
                  << " %, without healing " << std::round(100. * without) << "\n";
        off  = std::max(off, std::abs(with));
        kept = std::max(kept, std::abs(without));
      }
  std::cout << "within 3 %: " << yes(off < 0.03) << ", needed: " << yes(kept > 0.15) << "\n";
}
