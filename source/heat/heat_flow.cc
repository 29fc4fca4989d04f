// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/heat/conduction_step.h>
#include <retroforge/heat/heat_flow.h>
#include <retroforge/heat/skin.h>

namespace retroforge
{
  namespace
  {
    constexpr double stefan_boltzmann = 5.670374419e-11; // [mW/(mm² K⁴)]
    constexpr double absolute_zero    = -273.15;         // [C]

    /// What the skin beneath a node's contacts depends on.
    template <typename Number>
    struct SkinArguments
    {
      Number e, h, k, capacity, die_effusivity, depth, dt;

      template <typename Self>
      static auto members(Self &self)
      {
        auto &[e, h, k, capacity, die_effusivity, depth, dt] = self;
        return std::tie(e, h, k, capacity, die_effusivity, depth, dt);
      }
    };

    /// Effusivity of metal and die together, and the metal's part of the drop in the skins.
    template <typename Number>
    std::pair<Number, Number> together(const SkinArguments<Number> &of)
    {
      using std::sqrt;
      const Number metal = sqrt(Number(of.k * of.capacity)),
                   both  = joint_effusivity(metal, of.die_effusivity);
      return {both, both / metal};
    }

    /// R for skins with the Biot number y.
    template <typename Number>
    Number skin_resistance(const SkinArguments<Number> &of, const Number &metals_part, const Number &y)
    {
      const Number thickness = 3. * of.k * y * metals_part / of.h;
      const Number rest      = 1. - thickness / (8. * of.depth);
      const Number resolved  = value_of(rest) > 0. ? Number(rest * rest) : Number(0.);
      return y * (metals_part * resolved + (1. - metals_part));
    }

    /// The skin after the time, and the mean of 1/(1 + R).
    template <typename Number>
    SkinStep<Number> beneath_contacts(const SkinArguments<Number> &of)
    {
      const auto [effusivity, metals_part] = together(of);
      const SkinStep<Number> step          = skin_step(of.e, of.h, Number(effusivity * effusivity), of.dt);
      const Number           y             = 1. / step.mean - 1.;
      return {step.e, 1. / (1. + skin_resistance(of, metals_part, y))};
    }

    /// What of each node touches dies: sums over them of w and of areas.
    template <typename Number>
    struct Touching
    {
      std::vector<Number> weight, area;

      explicit Touching(const HeatFlow<Number> &flow)
          : weight(flow.network.volumes.size(), Number(0.)), area(weight)
      {
        for (const auto &at : flow.surface.touching)
        {
          weight[at.node] += at.weight;
          area[at.node] += at.area;
        }
      }

      /// Whether a node has a film to a die.
      bool has_film(const HeatFlow<Number> &flow, const NodeIndex k) const
      {
        return value_of(weight[k]) > 0. && value_of(area[k]) > 0. && value_of(flow.contact_film) > 0.;
      }
    };

    template <typename Number>
    SkinArguments<Number> arguments_at(const HeatFlow<Number> &flow,
                                       const NodeIndex         k,
                                       const Touching<Number> &touching,
                                       const Number           &e,
                                       const Number           &dt)
    {
      const HeatLaw<Number> &law = flow.law;
      return {e,
              flow.contact_film * touching.weight[k],
              law.conductivity,
              law.capacity,
              law.die_effusivity,
              flow.network.volumes[k] / touching.area[k],
              dt};
    }

    /// Derivatives in what of each node touches dies.
    struct NodeBar
    {
      std::vector<double> weight, area;

      explicit NodeBar(const HeatFlow<double> &flow) : weight(flow.network.volumes.size(), 0.), area(weight)
      {
      }

      /// Reverse of arguments_at(), but for e and dt.
      void reverse_arguments(const HeatFlow<double>      &flow,
                             const NodeIndex              k,
                             const Touching<double>      &touching,
                             const SkinArguments<double> &x_bar,
                             HeatFlowBar                 &bar)
      {
        const double of_node = touching.area[k];
        bar.contact_film += x_bar.h * touching.weight[k];
        bar.law.conductivity += x_bar.k;
        bar.law.capacity += x_bar.capacity;
        bar.law.die_effusivity += x_bar.die_effusivity;
        bar.network.volumes[k] += x_bar.depth / of_node;
        weight[k] += x_bar.h * flow.contact_film;
        area[k] -= x_bar.depth * flow.network.volumes[k] / (of_node * of_node);
      }

      /// Reverse of Touching's sums.
      void reverse_touching(const HeatFlow<double> &flow, HeatFlowBar &bar) const
      {
        for (std::size_t i = 0; i < flow.surface.touching.size(); ++i)
        {
          bar.surface.weight[i] += weight[flow.surface.touching[i].node];
          bar.surface.touching_area[i] += area[flow.surface.touching[i].node];
        }
      }
    };

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

    /// Films to the dies.
    template <typename Number>
    NodeFilms<Number> contact_films(const HeatFlow<Number> &flow, const std::vector<Number> &parts)
    {
      NodeFilms<Number> films(flow.network.volumes.size());
      for (const auto &at : flow.surface.touching)
      {
        const Number phi = at.area * flow.contact_film * parts[at.node];
        films.conductance[at.node] += phi;
        films.source[at.node] += phi * flow.dies[at.die].temperature;
      }
      return films;
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

    /// The parts 1/(1 + R) of films to dies; skins go on.
    template <typename Number>
    std::vector<Number>
    follow_skins(const HeatFlow<Number> &flow, const Number &dt, std::vector<Number> &skin)
    {
      const Touching<Number> touching(flow);
      std::vector<Number>    parts(skin.size(), Number(1.));
      for (NodeIndex k = 0; k < skin.size(); ++k)
        if (touching.has_film(flow, k))
        {
          const auto step = beneath_contacts(arguments_at(flow, k, touching, skin[k], dt));
          skin[k]         = step.e;
          parts[k]        = step.mean;
        }
      return parts;
    }
  } // namespace

  template <typename Number>
  Number
  conduct(const HeatFlow<Number> &flow, const Number &dt, std::vector<Number> &T, std::vector<Number> &skin)
  {
    AssertDimension(T.size(), flow.network.volumes.size());
    AssertDimension(skin.size(), T.size());
    const NodeFilms<Number>   contact = contact_films(flow, follow_skins(flow, dt, skin));
    const std::vector<Number> C       = scaled(flow.law.capacity, flow.network.volumes),
                              g       = scaled(flow.law.conductivity, flow.network.conductances),
                              bounded = scaled(flow.law.conductivity, flow.network.bounded);
    auto   result = conduction_step<Number>({flow.edges, C, g, bounded, dt}, T, films_at(flow, contact));
    Number heat(0.);
    for (const Number &of_node : result.film_heat)
      heat += of_node;
    T = std::move(result.T);
    return heat;
  }

  template double
  conduct(const HeatFlow<double> &, const double &, std::vector<double> &, std::vector<double> &);
  template Dual conduct(const HeatFlow<Dual> &, const Dual &, std::vector<Dual> &, std::vector<Dual> &);

  void reverse_conduct(const HeatFlow<double>    &flow,
                       const double               dt,
                       const std::vector<double> &T,
                       const std::vector<double> &skin,
                       std::vector<double>       &T_bar,
                       std::vector<double>       &skin_bar,
                       HeatFlowBar               &bar)
  {
    const std::size_t         n       = T.size();
    std::vector<double>       after   = skin;
    const std::vector<double> parts   = follow_skins(flow, dt, after);
    const NodeFilms<double>   contact = contact_films(flow, parts);
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
    T_bar = reverse_conduction_step(
      {flow.edges, C, g, bounded, dt}, T, films_at(flow, contact), T_bar, reverse_films, step_bar);
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

    // Films to the dies.
    std::vector<double> parts_bar(n, 0.);
    for (std::size_t i = 0; i < flow.surface.touching.size(); ++i)
    {
      const auto  &at = flow.surface.touching[i];
      const double t = flow.dies[at.die].temperature, film = flow.contact_film;
      const double phi_bar = contact_bar.conductance[at.node] + contact_bar.source[at.node] * t;
      bar.dies[at.die].temperature += contact_bar.source[at.node] * at.area * film * parts[at.node];
      bar.surface.touching_area[i] += phi_bar * film * parts[at.node];
      bar.contact_film += phi_bar * at.area * parts[at.node];
      parts_bar[at.node] += phi_bar * at.area * film;
    }

    // Skins.
    const Touching<double> touching(flow);
    NodeBar                nodes(flow);
    for (NodeIndex k = 0; k < n; ++k)
      if (touching.has_film(flow, k))
      {
        using Partial                = Sacado::Fad::SFad<double, 7>;
        SkinArguments<double>  x_bar = arguments_at<double>(flow, k, touching, skin[k], dt);
        SkinArguments<Partial> x;
        int                    i = 0;
        for_each_number([&](const double value, Partial &to) { to = Partial(7, i++, value); }, x_bar, x);
        const auto step = beneath_contacts(x);
        i               = 0;
        for_each_number(
          [&](double &to) {
            to = skin_bar[k] * step.e.dx(i) + parts_bar[k] * step.mean.dx(i);
            ++i;
          },
          x_bar);
        skin_bar[k] = x_bar.e;
        bar.dt += x_bar.dt;
        nodes.reverse_arguments(flow, k, touching, x_bar, bar);
      }
    nodes.reverse_touching(flow, bar);
  }

  namespace
  {
    /// What the temperatures at a node's surface depend on.
    template <typename Number>
    struct SurfaceArguments
    {
      SkinArguments<Number> skin;
      Number                T, partner; ///< of the metal beneath, and of the dies [C]

      template <typename Self>
      static auto members(Self &self)
      {
        auto &[skin, T, partner] = self;
        return std::tie(skin, T, partner);
      }
    };

    /// Of the metal, and of the dies.
    template <typename Number>
    std::array<Number, 2> at_surface(const SurfaceArguments<Number> &of)
    {
      const auto [effusivity, metals_part] = together(of.skin);
      const Number y                       = skin_biot(of.skin.e, of.skin.h, Number(effusivity * effusivity));
      const Number resistance              = skin_resistance(of.skin, metals_part, y);
      const Number flux                    = (of.T - of.partner) / (1. + resistance); // over the film
      const Number die                     = of.partner + flux * y * (1. - metals_part);
      return {{Number(die + flux), die}};
    }

    /// The mean temperature of the dies that each node touches.
    template <typename Number>
    std::vector<Number> partners(const HeatFlow<Number> &flow, const Touching<Number> &touching)
    {
      std::vector<Number> mean(flow.network.volumes.size(), Number(0.));
      for (const auto &at : flow.surface.touching)
        if (value_of(at.weight) > 0.)
          mean[at.node] += at.weight / touching.weight[at.node] * flow.dies[at.die].temperature;
      return mean;
    }

    /// Steps in time do not matter here.
    template <typename Number>
    SurfaceArguments<Number> surface_arguments(const HeatFlow<Number>    &flow,
                                               const NodeIndex            k,
                                               const Touching<Number>    &touching,
                                               const std::vector<Number> &partner,
                                               const std::vector<Number> &T,
                                               const std::vector<Number> &skin)
    {
      return {arguments_at(flow, k, touching, skin[k], Number(1.)), T[k], partner[k]};
    }
  } // namespace

  template <typename Number>
  std::array<std::vector<Number>, 2> surface_temperatures(const HeatFlow<Number>    &flow,
                                                          const std::vector<Number> &T,
                                                          const std::vector<Number> &skin)
  {
    AssertDimension(T.size(), flow.network.volumes.size());
    AssertDimension(skin.size(), T.size());
    const Touching<Number>    touching(flow);
    const std::vector<Number> partner = partners(flow, touching);
    std::vector<Number>       metal   = T, die(T.size(), Number(0.));
    for (NodeIndex k = 0; k < T.size(); ++k)
      if (touching.has_film(flow, k))
      {
        const auto both = at_surface(surface_arguments(flow, k, touching, partner, T, skin));
        metal[k]        = both[0];
        die[k]          = both[1];
      }
    return {{metal, die}};
  }

  template std::array<std::vector<double>, 2>
  surface_temperatures(const HeatFlow<double> &, const std::vector<double> &, const std::vector<double> &);
  template std::array<std::vector<Dual>, 2>
  surface_temperatures(const HeatFlow<Dual> &, const std::vector<Dual> &, const std::vector<Dual> &);

  void reverse_surface_temperatures(const HeatFlow<double>                   &flow,
                                    const std::vector<double>                &T,
                                    const std::vector<double>                &skin,
                                    const std::array<std::vector<double>, 2> &surfaces_bar,
                                    std::vector<double>                      &T_bar,
                                    std::vector<double>                      &skin_bar,
                                    HeatFlowBar                              &bar)
  {
    const Touching<double>    touching(flow);
    const std::vector<double> partner = partners(flow, touching);
    NodeBar                   nodes(flow);
    std::vector<double>       partner_bar(T.size(), 0.);
    for (NodeIndex k = 0; k < T.size(); ++k)
    {
      const double metal_bar = surfaces_bar[0][k], die_bar = surfaces_bar[1][k];
      if (!touching.has_film(flow, k))
        T_bar[k] += metal_bar;
      else if (metal_bar != 0. || die_bar != 0.)
      {
        using Partial = Sacado::Fad::SFad<double, 9>;
        SurfaceArguments<Partial> x;
        SurfaceArguments<double>  x_bar = surface_arguments(flow, k, touching, partner, T, skin);
        int                       i     = 0;
        for_each_number([&](const double value, Partial &to) { to = Partial(9, i++, value); }, x_bar, x);
        const auto both = at_surface(x);
        i               = 0;
        for_each_number(
          [&](double &to) {
            to = metal_bar * both[0].dx(i) + die_bar * both[1].dx(i);
            ++i;
          },
          x_bar);
        T_bar[k] += x_bar.T;
        partner_bar[k] = x_bar.partner;
        skin_bar[k] += x_bar.skin.e;
        nodes.reverse_arguments(flow, k, touching, x_bar.skin, bar);
      }
    }
    for (std::size_t i = 0; i < flow.surface.touching.size(); ++i)
      if (const auto &at = flow.surface.touching[i]; at.weight > 0.)
      {
        const double of_node = partner_bar[at.node] / touching.weight[at.node],
                     t       = flow.dies[at.die].temperature;
        bar.dies[at.die].temperature += of_node * at.weight;
        bar.surface.weight[i] += of_node * (t - partner[at.node]);
      }
    nodes.reverse_touching(flow, bar);
  }

  namespace
  {
    template <typename Number>
    std::vector<bool> dies_in_press(const std::vector<DieState<Number>> &dies)
    {
      std::vector<bool> touch;
      for (const auto &die : dies)
        touch.push_back(die.in_press == 1);
      return touch;
    }
  } // namespace

  template <typename Number>
  HeatUnderPress<Number>::HeatUnderPress(const ContactView<Number> &view, const HeatLaw<Number> &law)
      : edges(view.mesh, view.topology)
      , network(conduction_network(view.mesh, edges, view.X))
      , surface(thermal_surface(view, dies_in_press(view.states), value_of(law.gap)))
      , flow{edges, network, surface, law, law.contact_film, view.states}
  {
  }

  template struct HeatUnderPress<double>;
  template struct HeatUnderPress<Dual>;
} // namespace retroforge
