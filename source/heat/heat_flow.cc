// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/heat/conduction_step.h>
#include <retroforge/heat/heat_flow.h>
#include <retroforge/heat/node_skins.h>

#include <optional>

namespace retroforge
{
  namespace
  {
    constexpr double stefan_boltzmann = 5.670374419e-11; // [mW/(mm² K⁴)]
    constexpr double absolute_zero    = -273.15;         // [C]

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

    /// h/b, of metal and die together.
    template <typename Number>
    Number film_rate(const HeatFlow<Number> &flow)
    {
      const Number metal = metals_effusivity(flow.law.conductivity, flow.law.capacity);
      return flow.contact_film / joint_effusivity(metal, flow.law.die_effusivity);
    }

    /// The time in which a node touches no die. It comes first: to a node that arrives.
    template <typename Number>
    Number open_time(const NodeContacts<Number> &touching, const NodeIndex k, const Number &dt)
    {
      const Number open = 1. - touching.weight[k];
      return value_of(open) > 0. ? Number(open * dt) : Number(0.);
    }

    /// What times make of skins. Most nodes touch all of the time, or none of it.
    template <typename Number>
    class SkinsOverStep
    {
    public:
      SkinsOverStep(const Number &rate, const Number &dt)
          : rate_(rate), dt_(value_of(dt)), healing_(healing(dt))
      {
        if (value_of(rate) > 0.)
          whole_.emplace(film_.emplace(value_of(rate)), dt_);
      }

      Skin<Number> left(const Number &open) const { return value_of(open) == dt_ ? healing_ : healing(open); }

      /// f(SkinPropagator) of a time that a node touches.
      template <typename F>
      auto touching(const double time, const F &f) const
      {
        return time == dt_ ? f(*whole_) : f(SkinPropagator(*film_, time));
      }

      const Number &rate() const { return rate_; }

      SkinsOverStep(const SkinsOverStep &) = delete; // the propagator refers to the film

    private:
      Number                          rate_;
      double                          dt_;
      Skin<Number>                    healing_;
      std::optional<SkinsBeneathFilm> film_;
      std::optional<SkinPropagator>   whole_;
    };

    /// The parts 1/(1 + R) of films to dies; skins go on.
    template <typename Number>
    std::vector<Number>
    follow_skins(const HeatFlow<Number> &flow, const Number &dt, std::vector<Skin<Number>> &skin)
    {
      const NodeContacts<Number>  touching(flow);
      const SkinsOverStep<Number> skins(film_rate(flow), dt);
      std::vector<Number>         parts(skin.size(), Number(1.));
      for (NodeIndex k = 0; k < skin.size(); ++k)
      {
        if (value_of(drop_of(skin[k])) > 0.)
          skin[k] = healed(skin[k], skins.left(open_time(touching, k, dt)));
        if (touching.has_film(flow, k))
        {
          const Number time = touching.weight[k] * dt;
          const auto   step = skins.touching(value_of(time), [&](const SkinPropagator &over) {
            return skin_step(over, skins.rate(), skin[k], time);
          });
          skin[k]           = step.after;
          parts[k]          = 1. / drops_at(skin_arguments(flow, k, touching, step.mean)).all;
        }
      }
      return parts;
    }

    /// Reverse of follow_skins().
    /// @param skin      before
    /// @param skin_bar  derivatives in those after on entry, in those before on exit
    void reverse_follow_skins(const HeatFlow<double>          &flow,
                              const double                     dt,
                              const std::vector<Skin<double>> &skin,
                              const std::vector<double>       &parts_bar,
                              std::vector<Skin<double>>       &skin_bar,
                              HeatFlowBar                     &bar)
    {
      const NodeContacts<double>  touching(flow);
      NodeContactsBar             nodes(flow);
      const SkinsOverStep<double> skins(film_rate(flow), dt);
      double                      rate_bar = 0.;
      for (NodeIndex k = 0; k < skin.size(); ++k)
      {
        const bool   is_there = drop_of(skin[k]) > 0.;
        const double open     = open_time(touching, k, dt);
        if (touching.has_film(flow, k))
        {
          using Partial             = Sacado::Fad::SFad<double, n_skin_arguments>;
          const Skin<double> before = is_there ? healed(skin[k], skins.left(open)) : skin[k];
          skins.touching(touching.weight[k] * dt, [&](const SkinPropagator &over) {
            SkinArguments<double>  x_bar = skin_arguments(flow, k, touching, over.step(before).mean);
            SkinArguments<Partial> x;
            int                    i = 0;
            for_each_number(
              [&](const double value, Partial &to) { to = Partial(n_skin_arguments, i++, value); }, x_bar, x);
            const Partial part = 1. / drops_at(x).all;
            i                  = 0;
            for_each_number([&](double &to) { to = parts_bar[k] * part.dx(i++); }, x_bar);
            nodes.reverse_arguments(flow, k, touching, x_bar, bar);
            const SkinStep<double> step_bar{skin_bar[k], x_bar.drops};
            const auto             slopes = over.slopes(before);
            const auto             along  = [&](const SkinStep<double> &slope) {
              return slope.after * step_bar.after + slope.mean * step_bar.mean;
            };
            rate_bar += along(slopes[0]);
            const double time_bar = along(slopes[1]);
            nodes.weight[k] += time_bar * dt;
            bar.dt += time_bar * touching.weight[k];
            skin_bar[k] = over.reverse_carried(step_bar);
          });
        }
        if (is_there)
          skin_bar[k] = healed(skin_bar[k], skins.left(open));
        if (is_there && open > 0.)
        {
          double open_bar = 0.;
          for (unsigned int j = 0; j < n_skin_modes; ++j)
            open_bar -= skin_rates[j] * skin_bar[k][j] * skin[k][j];
          nodes.weight[k] -= open_bar * dt;
          bar.dt += open_bar * (1. - touching.weight[k]);
        }
      }
      nodes.reverse_touching(flow, bar);

      // rate = h (1/b_m + 1/b_d)
      const double metal = metals_effusivity(flow.law.conductivity, flow.law.capacity),
                   die = flow.law.die_effusivity, metal_bar = -rate_bar * flow.contact_film / (metal * metal);
      bar.contact_film += rate_bar / joint_effusivity(metal, die);
      bar.law.conductivity += metal_bar * 0.5 * metal / flow.law.conductivity;
      bar.law.capacity += metal_bar * 0.5 * metal / flow.law.capacity;
      bar.law.die_effusivity -= rate_bar * flow.contact_film / (die * die);
    }
  } // namespace

  template <typename Number>
  Number conduct(const HeatFlow<Number>    &flow,
                 const Number              &dt,
                 std::vector<Number>       &T,
                 std::vector<Skin<Number>> &skin)
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
  conduct(const HeatFlow<double> &, const double &, std::vector<double> &, std::vector<Skin<double>> &);
  template Dual conduct(const HeatFlow<Dual> &, const Dual &, std::vector<Dual> &, std::vector<Skin<Dual>> &);

  void reverse_conduct(const HeatFlow<double>          &flow,
                       const double                     dt,
                       const std::vector<double>       &T,
                       const std::vector<Skin<double>> &skin,
                       std::vector<double>             &T_bar,
                       std::vector<Skin<double>>       &skin_bar,
                       HeatFlowBar                     &bar)
  {
    const std::size_t         n       = T.size();
    std::vector<Skin<double>> after   = skin;
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

    reverse_follow_skins(flow, dt, skin, parts_bar, skin_bar, bar);
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
