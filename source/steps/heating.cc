// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/heat/healing.h>
#include <retroforge/steps/heating.h>

namespace retroforge
{
  namespace
  {
    /// A time that heat flows, in steps.
    template <typename Number>
    struct Spell
    {
      enum class Of
      {
        transfer,
        dwell,
        press
      };

      Of                  of;
      std::vector<bool>   touch; ///< the dies that are there
      Number              time;  ///< [s]
      std::vector<double> parts; ///< of the time

      /// Whether skins heal where nothing touches. Under the press, a contact that opens is one that closes again.
      bool heals() const { return of != Of::press; }
    };

    /// Steps that grow in proportion to their number: what begins does so fast.
    std::vector<double> growing_steps(const unsigned int n)
    {
      std::vector<double> parts;
      for (unsigned int i = 0; i < n; ++i)
        parts.push_back((2. * i + 1.) / (double(n) * n));
      return parts;
    }

    /// Which dies stand in the press.
    template <typename Number>
    std::vector<bool> dies_in(const Process<Number> &process, const StrokeStep &at)
    {
      std::vector<bool> touch(process.dies.size());
      for (unsigned int d = 0; d < touch.size(); ++d)
        touch[d] = process.operations[at.operation].has(d);
      return touch;
    }

    template <typename Number>
    std::vector<Spell<Number>>
    spells_of(const HalfOfIncrement half, const Process<Number> &process, const StrokeStep &at)
    {
      using Of = typename Spell<Number>::Of;
      std::vector<Spell<Number>> spells;
      if (half == HalfOfIncrement::first && at.stroke == 0.)
      {
        const Waiting<Number>    &waiting = process.operations[at.operation].waiting;
        const std::vector<double> steps   = growing_steps(process.heat.waiting_steps);
        std::vector<bool>         touch(process.dies.size(), false);
        if (value_of(waiting.transfer) > 0.)
          spells.push_back({Of::transfer, touch, waiting.transfer, steps});
        if (value_of(waiting.dwell) > 0.)
        {
          touch[waiting.resting_die] = true;
          spells.push_back({Of::dwell, touch, waiting.dwell, steps});
        }
      }
      spells.push_back({Of::press, dies_in(process, at), 0.5 * process.duration(at), {1.}});
      return spells;
    }

    template <typename Law, typename Of>
    auto &film_of(Law &heat, const Of of)
    {
      return of == Of::dwell ? heat.dwell_film : heat.contact_film;
    }

    StrokeStep place_of(const HalfOfIncrement half, const StrokeStep &at)
    {
      return {half == HalfOfIncrement::first ? at.stroke : at.stroke + at.step, 0., at.operation};
    }
  } // namespace

  template <typename Number>
  Number conduct_over(const HalfOfIncrement       half,
                      const Scene                &scene,
                      const NetworkEdges         &edges,
                      const Process<Number>      &process,
                      const StrokeStep           &at,
                      const NodalVectors<Number> &X,
                      WorkpieceState<3, Number>  &state)
  {
    Number heat(0.);
    if (!process.heat.conducts())
      return heat;
    const auto   dies    = process.over(place_of(half, at)).dies;
    const auto   network = conduction_network(scene.mesh, edges, X);
    const double gap     = value_of(process.heat.gap);
    for (const auto &spell : spells_of(half, process, at))
    {
      const auto surface = thermal_surface(scene.view(dies, X), spell.touch, gap);
      if (spell.heals())
        heal_skins(surface, process.heat, spell.time, state.skin);
      for (const double part : spell.parts)
        heat += conduct({edges, network, surface, process.heat, film_of(process.heat, spell.of), dies},
                        Number(part * spell.time),
                        state.temperature,
                        state.skin);
    }
    return heat;
  }

  template double conduct_over(HalfOfIncrement,
                               const Scene &,
                               const NetworkEdges &,
                               const Process<double> &,
                               const StrokeStep &,
                               const NodalVectors<double> &,
                               WorkpieceState<3, double> &);
  template Dual   conduct_over(HalfOfIncrement,
                               const Scene &,
                               const NetworkEdges &,
                               const Process<Dual> &,
                               const StrokeStep &,
                               const NodalVectors<Dual> &,
                               WorkpieceState<3, Dual> &);

  std::array<std::vector<double>, 2> surface_temperatures(const Scene                     &scene,
                                                          const Process<double>           &process,
                                                          const StrokeStep                &at,
                                                          const WorkpieceState<3, double> &state)
  {
    if (!process.heat.conducts())
      return {};
    const auto                   dies = process.over(place_of(HalfOfIncrement::second, at)).dies;
    const HeatUnderPress<double> heat(scene.view(dies, state.X), process.heat);
    return surface_temperatures(heat.flow, state.temperature, state.skin);
  }

  void reverse_conduct_over(const HalfOfIncrement            half,
                            const Scene                     &scene,
                            const NetworkEdges              &edges,
                            const Process<double>           &process,
                            const StrokeStep                &at,
                            const NodalVectors<double>      &X,
                            const WorkpieceState<3, double> &state,
                            std::vector<Costate>            &costates)
  {
    if (!process.heat.conducts())
      return;
    using Of             = Spell<double>::Of;
    const auto   place   = place_of(half, at);
    const auto   dies    = process.over(place).dies;
    const auto   view    = scene.view(dies, X);
    const auto   network = conduction_network(scene.mesh, edges, X);
    const double gap     = process.heat.gap;
    const auto   spells  = spells_of(half, process, at);

    // Temperatures and skins before each step of each spell.
    std::vector<ThermalSurface<double>>                                       surfaces;
    std::vector<std::vector<std::pair<NodeField<double>, NodeField<double>>>> before(spells.size());
    std::vector<NodeField<double>>                                            not_healed;
    NodeField<double> T = state.temperature, skin = state.skin;
    for (std::size_t i = 0; i < spells.size(); ++i)
    {
      surfaces.push_back(thermal_surface(view, spells[i].touch, gap));
      not_healed.push_back(skin);
      if (spells[i].heals())
        heal_skins(surfaces[i], process.heat, spells[i].time, skin);
      for (const double part : spells[i].parts)
      {
        before[i].emplace_back(T, skin);
        if (i + 1 == spells.size() && before[i].size() == spells[i].parts.size())
          break; // nothing comes after it
        conduct({edges, network, surfaces[i], process.heat, film_of(process.heat, spells[i].of), dies},
                part * spells[i].time,
                T,
                skin);
      }
    }
    for (Costate &costate : costates)
    {
      WorkpieceState<3, double> &workpiece = costate.workpiece;
      if (is_zero(workpiece.temperature) && is_zero(workpiece.skin))
        continue;
      PhysicsBar                physics(scene.dies);
      ConductionNetwork<double> network_bar = no_derivatives(network);
      Waiting<double>           waiting_bar;
      double                    press_bar = 0.; // in the increment's time
      for (std::size_t i = spells.size(); i-- > 0;)
      {
        ThermalSurfaceBar surface_bar(surfaces[i]);
        double            time_bar = 0.;
        for (std::size_t s = spells[i].parts.size(); s-- > 0;)
        {
          double      dt_bar = 0.;
          HeatFlowBar bar{network_bar,
                          surface_bar,
                          physics.heat,
                          film_of(physics.heat, spells[i].of),
                          physics.dies,
                          dt_bar};
          reverse_conduct(
            {edges, network, surfaces[i], process.heat, film_of(process.heat, spells[i].of), dies},
            spells[i].parts[s] * spells[i].time,
            before[i][s].first,
            before[i][s].second,
            workpiece.temperature,
            workpiece.skin,
            bar);
          time_bar += spells[i].parts[s] * dt_bar;
        }
        if (spells[i].heals())
          reverse_heal_skins(surfaces[i],
                             process.heat,
                             spells[i].time,
                             not_healed[i],
                             workpiece.skin,
                             {surface_bar, physics.heat, time_bar});
        reverse_thermal_surface(view, surfaces[i], gap, surface_bar, workpiece.X, physics.dies);
        switch (spells[i].of)
        {
          case Of::transfer:
            waiting_bar.transfer += time_bar;
            break;
          case Of::dwell:
            waiting_bar.dwell += time_bar;
            break;
          case Of::press:
            press_bar += 0.5 * time_bar;
            break;
        }
      }
      reverse_conduction_network(scene.mesh, edges, X, network_bar, workpiece.X);
      costate.process.add_once([&](Process<double> &part) {
        reverse_over(process, place, 0., physics, part);
        PhysicsBar time(scene.dies);
        time.dt = press_bar;
        reverse_over(process, at, 0., time, part);
        add_numbers(waiting_bar, part.operations[at.operation].waiting);
      });
    }
  }
} // namespace retroforge
