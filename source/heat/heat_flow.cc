// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/heat/conduction_step.h>
#include <retroforge/heat/contact_skins.h>
#include <retroforge/heat/heat_flow.h>
#include <retroforge/material/temperature_range.h>

namespace retroforge
{
  namespace
  {
    constexpr double stefan_boltzmann = 5.670374419e-11; // [mW/(mm² K⁴)]

    /// Film of a free surface by convection and radiation.
    template <typename Number>
    Number air_film(const HeatLaw<Number> &law, const Number &T)
    {
      const Number t = T - absolute_zero, a = law.surroundings - absolute_zero;
      return law.air_film + law.emissivity * stefan_boltzmann * (t * t + a * a) * (t + a);
    }

    template <typename Number>
    std::vector<Number> scaled(const Number &factor, std::vector<Number> x)
    {
      for (Number &value : x)
        value *= factor;
      return x;
    }

    template <typename Number>
    FilmsAt<Number> films_at(const HeatFlow<Number> &flow, const NodeFilms<Number> &contact)
    {
      return [&flow, &contact](const std::vector<Number> &T) {
        NodeFilms<Number> films = contact;
        for (NodeIndex k = 0; k < T.size(); ++k)
          if (value_of(flow.surface.free[k]) > 0.)
          {
            const Number phi = flow.surface.free[k] * air_film(flow.law, T[k]);
            films.conductance[k] += phi;
            films.source[k] += phi * flow.law.surroundings;
          }
        return films;
      };
    }
  } // namespace

  template <typename Number>
  Number
  conduct(const HeatFlow<Number> &flow, const Number &dt, std::vector<Number> &T, NodeSkins<Number> &skin)
  {
    AssertDimension(T.size(), flow.network.volumes.size());
    AssertDimension(skin.metal.size(), T.size());
    AssertDimension(skin.dies.size(), flow.dies.size());
    const ContactSkins<Number> skins(flow, dt, T, skin);
    const NodeFilms<Number>    contact = skins.films();
    const std::vector<Number>  C       = scaled(flow.law.capacity, flow.network.volumes),
                              g        = scaled(flow.law.conductivity, flow.network.conductances),
                              bounded  = scaled(flow.law.conductivity, flow.network.bounded);
    auto   result = conduction_step<Number>({flow.edges, C, g, bounded, dt}, T, films_at(flow, contact));
    Number heat(0.);
    for (const Number &of_node : result.film_heat)
      heat += of_node;
    skins.advance(result.at_films, skin);
    T = std::move(result.T);
    return heat;
  }

  template double
                conduct(const HeatFlow<double> &, const double &, std::vector<double> &, NodeSkins<double> &);
  template Dual conduct(const HeatFlow<Dual> &, const Dual &, std::vector<Dual> &, NodeSkins<Dual> &);

  void reverse_conduct(const HeatFlow<double>    &flow,
                       const double               dt,
                       const std::vector<double> &T,
                       const NodeSkins<double>   &skin,
                       std::vector<double>       &T_bar,
                       NodeSkins<double>         &skin_bar,
                       HeatFlowBar               &bar)
  {
    const std::size_t         n = T.size();
    const ReverseContactSkins skins(flow, dt, T, skin);
    const NodeFilms<double>   contact = skins.films();
    const std::vector<double> C       = scaled(flow.law.capacity, flow.network.volumes),
                              g       = scaled(flow.law.conductivity, flow.network.conductances),
                              bounded = scaled(flow.law.conductivity, flow.network.bounded);
    std::vector<double> C_bar(n, 0.), g_bar(g.size(), 0.), bounded_bar(g_bar);
    NodeFilms<double>   contact_bar(n);
    ConductionStepBar   step_bar{C_bar, g_bar, bounded_bar};

    const auto reverse_films =
      [&](const std::vector<double> &at, const NodeFilms<double> &films_bar, std::vector<double> &at_bar) {
        for (NodeIndex k = 0; k < n; ++k)
        {
          contact_bar.conductance[k] += films_bar.conductance[k];
          contact_bar.source[k] += films_bar.source[k];
          if (!(flow.surface.free[k] > 0.))
            continue;
          const double film = air_film(flow.law, at[k]), free = flow.surface.free[k];
          const double phi_bar = films_bar.conductance[k] + films_bar.source[k] * flow.law.surroundings;
          bar.law.surroundings += films_bar.source[k] * free * film;
          bar.surface.free[k] += phi_bar * film;
          const double film_bar = phi_bar * free;
          const double t = at[k] - absolute_zero, a = flow.law.surroundings - absolute_zero;
          const double radiated = stefan_boltzmann * (t * t + a * a) * (t + a);
          const double scale    = flow.law.emissivity * stefan_boltzmann * film_bar;
          bar.law.air_film += film_bar;
          bar.law.emissivity += film_bar * radiated;
          at_bar[k] += scale * (3. * t * t + 2. * t * a + a * a);
          bar.law.surroundings += scale * (3. * a * a + 2. * t * a + t * t);
        }
      };
    auto reversed = reverse_conduction_step({flow.edges, C, g, bounded, dt},
                                            T,
                                            films_at(flow, contact),
                                            T_bar,
                                            skins.reverse_temperatures(skin_bar),
                                            reverse_films,
                                            step_bar);
    T_bar         = std::move(reversed.T_bar);
    bar.dt += step_bar.dt;
    for (NodeIndex k = 0; k < n; ++k)
    {
      bar.law.capacity += C_bar[k] * flow.network.volumes[k];
      bar.network.volumes[k] += C_bar[k] * flow.law.capacity;
    }
    for (std::size_t e = 0; e < g.size(); ++e)
    {
      bar.law.conductivity +=
        g_bar[e] * flow.network.conductances[e] + bounded_bar[e] * flow.network.bounded[e];
      bar.network.bounded[e] += bounded_bar[e] * flow.law.conductivity;
      bar.network.conductances[e] += g_bar[e] * flow.law.conductivity;
    }

    skins.reverse(reversed.at_films, contact_bar, T_bar, skin_bar, bar);
  }

  template <typename Number>
  ThermalSurface<Number> surface_under_press(const ContactView<Number> &view, const double gap)
  {
    std::vector<bool> touch;
    for (const auto &die : view.states)
      touch.push_back(die.in_press == 1);
    return thermal_surface(view, touch, gap);
  }

  template ThermalSurface<double> surface_under_press(const ContactView<double> &, double);
  template ThermalSurface<Dual>   surface_under_press(const ContactView<Dual> &, double);
} // namespace retroforge
