// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/heat/healing.h>
#include <retroforge/heat/surface_temperature.h>
#include <retroforge/steps/heating.h>

#include <tuple>

namespace retroforge
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

  namespace
  {
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

  struct ReversibleConduction::Steps
  {
    const Scene                        &scene;
    const NetworkEdges                 &edges;
    const Process<double>              &process;
    const StrokeStep                    at, place;
    const NodalVectors<double>         &X;
    const std::vector<DieState<double>> dies       = process.over(place).dies;
    const ConductionNetwork<double>     network    = conduction_network(scene.mesh, edges, X);
    std::vector<Spell<double>>          spells     = {};
    std::vector<ThermalSurface<double>> surfaces   = {}; ///< of each spell
    std::vector<NodeField<double>>      not_healed = {}; ///< skins before each
    /// Temperatures and skins before each step of each spell.
    std::vector<std::vector<std::pair<NodeField<double>, NodeField<double>>>> before = {};

    HeatFlow<double> flow(const std::size_t i) const
    {
      return {edges, network, surfaces[i], process.heat, film_of(process.heat, spells[i].of), dies};
    }
    void take(const std::size_t i, const double part, NodeField<double> &T, NodeField<double> &skin) const
    {
      conduct(flow(i), part * spells[i].time, T, skin);
    }
  };

  ReversibleConduction::ReversibleConduction(const HalfOfIncrement            half,
                                             const Scene                     &scene,
                                             const NetworkEdges              &edges,
                                             const Process<double>           &process,
                                             const StrokeStep                &at,
                                             const NodalVectors<double>      &X,
                                             const WorkpieceState<3, double> &state)
  {
    if (!process.heat.conducts())
      return;
    const auto steps       = std::make_shared<Steps>(Steps{scene, edges, process, at, place_of(half, at), X});
    steps->spells          = spells_of(half, process, at);
    const auto        view = scene.view(steps->dies, X);
    NodeField<double> T = state.temperature, skin = state.skin;
    for (std::size_t i = 0; i < steps->spells.size(); ++i)
    {
      const Spell<double> &spell = steps->spells[i];
      steps->surfaces.push_back(thermal_surface(view, spell.touch, process.heat.gap));
      steps->not_healed.push_back(skin);
      if (spell.heals())
        heal_skins(steps->surfaces[i], process.heat, spell.time, skin);
      auto &before = steps->before.emplace_back();
      for (const double part : spell.parts)
      {
        before.emplace_back(T, skin);
        // What the last one leads to only take() asks for.
        if (i + 1 < steps->spells.size() || before.size() < spell.parts.size())
          steps->take(i, part, T, skin);
      }
    }
    steps_ = steps;
  }

  void ReversibleConduction::take(WorkpieceState<3, double> &state) const
  {
    if (!steps_)
      return;
    std::tie(state.temperature, state.skin) = steps_->before.back().back();
    steps_->take(
      steps_->spells.size() - 1, steps_->spells.back().parts.back(), state.temperature, state.skin);
  }

  void ReversibleConduction::reverse(std::vector<Costate> &costates) const
  {
    if (!steps_)
      return;
    using Of            = Spell<double>::Of;
    const Steps &of     = *steps_;
    const auto  &spells = of.spells;
    const auto   view   = of.scene.view(of.dies, of.X);
    const double gap    = of.process.heat.gap;
    for (Costate &costate : costates)
    {
      WorkpieceState<3, double> &workpiece = costate.workpiece;
      if (is_zero(workpiece.temperature) && is_zero(workpiece.skin))
        continue;
      PhysicsBar                physics(of.scene.dies);
      ConductionNetwork<double> network_bar = no_derivatives(of.network);
      Waiting<double>           waiting_bar;
      double                    press_bar = 0.; // in the increment's time
      for (std::size_t i = spells.size(); i-- > 0;)
      {
        ThermalSurfaceBar surface_bar(of.surfaces[i]);
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
          reverse_conduct(of.flow(i),
                          spells[i].parts[s] * spells[i].time,
                          of.before[i][s].first,
                          of.before[i][s].second,
                          workpiece.temperature,
                          workpiece.skin,
                          bar);
          time_bar += spells[i].parts[s] * dt_bar;
        }
        if (spells[i].heals())
          reverse_heal_skins(of.surfaces[i],
                             of.process.heat,
                             spells[i].time,
                             of.not_healed[i],
                             workpiece.skin,
                             {surface_bar, physics.heat, time_bar});
        reverse_thermal_surface(view, of.surfaces[i], gap, surface_bar, workpiece.X, physics.dies);
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
      reverse_conduction_network(of.scene.mesh, of.edges, of.X, network_bar, workpiece.X);
      costate.process.add_once([&](Process<double> &part) {
        reverse_over(of.process, of.place, 0., physics, part);
        PhysicsBar time(of.scene.dies);
        time.dt = press_bar;
        reverse_over(of.process, of.at, 0., time, part);
        add_numbers(waiting_bar, part.operations[of.at.operation].waiting);
      });
    }
  }
} // namespace retroforge
