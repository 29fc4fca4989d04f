// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/heat/surface_temperature.h>
#include <retroforge/steps/heating.h>

#include <tuple>

namespace retroforge
{
  enum class HalfOfIncrement
  {
    first,
    second
  };

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

    /// Tells whether an operation begins.
    bool is_first(const StrokeStep &at)
    {
      return at.stroke == 0.;
    }

    template <typename Number>
    NodeField<Number> no_friction(const WorkpieceState<3, Number> &state)
    {
      return NodeField<Number>(state.friction_flux.size(), Number(0.));
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
      if (half == HalfOfIncrement::first && is_first(at))
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

    /// Where the dies stand, and how they move, for the first half; where they stand for the second.
    StrokeStep place_of(const HalfOfIncrement half, const StrokeStep &at)
    {
      return half == HalfOfIncrement::first ? at : StrokeStep{at.stroke + at.step, 0., at.operation};
    }

    /// Metal comes nearer to dies under the press only.
    template <typename Number>
    ThermalReach reach_of(const Spell<Number> &spell, const HeatLaw<Number> &heat, const StrokeStep &at)
    {
      return {value_of(heat.gap), spell.of == Spell<Number>::Of::press ? at.step : 0.};
    }

    /// Lets heat flow for a spell.
    template <typename Number>
    void conduct_for(const Spell<Number>             &spell,
                     const NetworkEdges              &edges,
                     const ConductionNetwork<Number> &network,
                     const ThermalSurface<Number>    &surface,
                     const HeatLaw<Number>           &heat,
                     const Physics<Number>           &physics,
                     WorkpieceState<3, Number>       &state)
    {
      for (const double part : spell.parts)
        conduct({edges, network, surface, heat, film_of(heat, spell.of), physics.dies, &state.friction_flux},
                Number(part * spell.time),
                state.temperature,
                state.skin);
    }
  } // namespace

  template <typename Number>
  ThermalSurface<Number> conduct_before(const Scene               &scene,
                                        const NetworkEdges        &edges,
                                        const Process<Number>     &process,
                                        const StrokeStep          &at,
                                        WorkpieceState<3, Number> &state)
  {
    ThermalSurface<Number> surface;
    if (!process.heat.conducts())
      return surface;
    if (is_first(at))
      state.friction_flux = no_friction(state);
    const auto physics = process.over(place_of(HalfOfIncrement::first, at));
    const auto network = conduction_network(scene.mesh, edges, state.X);
    const auto view    = scene.view(physics.dies, state.X, &state.velocity);
    for (const auto &spell : spells_of(HalfOfIncrement::first, process, at))
    {
      surface = thermal_surface(view, spell.touch, reach_of(spell, process.heat, at));
      conduct_for(spell, edges, network, surface, process.heat, physics, state);
    }
    return surface;
  }

  template <typename Number>
  ThermalSurface<Number> conduct_after(const ThermalSurface<Number> &start,
                                       const Scene                  &scene,
                                       const NetworkEdges           &edges,
                                       const Process<Number>        &process,
                                       const StrokeStep             &at,
                                       const NodalVectors<Number>   &X,
                                       WorkpieceState<3, Number>    &state)
  {
    ThermalSurface<Number> surface;
    if (!process.heat.conducts())
      return surface;
    const auto physics = process.over(place_of(HalfOfIncrement::second, at));
    const auto network = conduction_network(scene.mesh, edges, X);
    for (const auto &spell : spells_of(HalfOfIncrement::second, process, at))
    {
      surface =
        thermal_surface_after(start, scene.view(physics.dies, X), spell.touch, value_of(process.heat.gap));
      conduct_for(spell, edges, network, surface, process.heat, physics, state);
    }
    return surface;
  }

#define RETROFORGE_INSTANTIATE(Number)                                          \
  template ThermalSurface<Number> conduct_before(const Scene &,                 \
                                                 const NetworkEdges &,          \
                                                 const Process<Number> &,       \
                                                 const StrokeStep &,            \
                                                 WorkpieceState<3, Number> &);  \
  template ThermalSurface<Number> conduct_after(const ThermalSurface<Number> &, \
                                                const Scene &,                  \
                                                const NetworkEdges &,           \
                                                const Process<Number> &,        \
                                                const StrokeStep &,             \
                                                const NodalVectors<Number> &,   \
                                                WorkpieceState<3, Number> &);
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE

  std::array<std::vector<double>, 2> surface_temperatures(const Scene                     &scene,
                                                          const Process<double>           &process,
                                                          const StrokeStep                &at,
                                                          const WorkpieceState<3, double> &state)
  {
    if (!process.heat.conducts())
      return {};
    const auto         dies    = process.over(place_of(HalfOfIncrement::second, at)).dies;
    const auto         surface = surface_under_press(scene.view(dies, state.X), process.heat.gap);
    const NetworkEdges edges(scene.mesh, scene.topology);
    const auto         network = conduction_network(scene.mesh, edges, state.X);
    return {{metals_surface({edges, network, surface, process.heat, process.heat.contact_film, dies},
                            state.temperature,
                            state.skin),
             means_at_nodes(
               surface, dies_surfaces(surface, dies, state.skin), std::vector<double>(state.X.size(), 0.))}};
  }

  /// Steps of a half, remembered. Friction's heat is that of the mechanics before, and so in the first half that of the
  /// increment before.
  struct ReversibleConduction::Steps
  {
    const Scene                        &scene;
    const NetworkEdges                 &edges;
    const Process<double>              &process;
    const HalfOfIncrement               half;
    const StrokeStep                    at, place;
    const NodalVectors<double>         &X;
    const std::vector<double>           friction;           ///< its heat, per area and time
    const ThermalSurface<double>       &under_press;        ///< what touches dies
    const NodalVectors<double>         *velocity = nullptr; ///< of the increment before
    const Steps                        *earlier  = nullptr; ///< the first half, of a second one
    std::vector<DieState<double>>       dies     = process.over(place).dies;
    ConductionNetwork<double>           network  = conduction_network(scene.mesh, edges, X);
    std::vector<Spell<double>>          spells   = spells_of(half, process, at);
    std::vector<ThermalSurface<double>> waiting  = {}; ///< what touches dies in each spell before the press
    /// Temperatures and skins before each step of each spell.
    std::vector<std::vector<std::pair<NodeField<double>, NodeSkins<double>>>> before = {};

    ContactView<double> view() const { return scene.view(dies, X, velocity); }

    const ThermalSurface<double> &surface(const std::size_t i) const
    {
      return i < waiting.size() ? waiting[i] : under_press;
    }
    HeatFlow<double> flow(const std::size_t i) const
    {
      return {edges, network, surface(i), process.heat, film_of(process.heat, spells[i].of), dies, &friction};
    }

    /// Goes through all steps but the last.
    void go(NodeField<double> T, NodeSkins<double> skin)
    {
      for (std::size_t i = 0; i < spells.size(); ++i)
      {
        const Spell<double> &spell = spells[i];
        if (spell.of != Spell<double>::Of::press)
          waiting.push_back(thermal_surface(view(), spell.touch, reach_of(spell, process.heat, at)));
        auto &states = before.emplace_back();
        for (const double part : spell.parts)
        {
          states.emplace_back(T, skin);
          if (i + 1 < spells.size() || states.size() < spell.parts.size())
            conduct(flow(i), part * spell.time, T, skin);
        }
      }
    }

    /// Takes a costate back over all of them.
    /// @param start_bar  in what touches under the press in the first half, from what the second made of it on entry
    void reverse(Costate &costate, ThermalSurfaceBar &start_bar) const
    {
      using Of                             = Spell<double>::Of;
      WorkpieceState<3, double> &workpiece = costate.workpiece;
      PhysicsBar                 physics(scene.dies);
      ConductionNetwork<double>  network_bar = no_derivatives(network);
      Waiting<double>            waiting_bar;
      double                     press_bar = 0.; // in the increment's time
      for (std::size_t i = spells.size(); i-- > 0;)
      {
        const bool        last = i + 1 == spells.size();
        ThermalSurfaceBar surface_bar(surface(i));
        if (!earlier && last)
          surface_bar = start_bar;
        double time_bar = 0.;
        for (std::size_t s = spells[i].parts.size(); s-- > 0;)
        {
          double      dt_bar = 0.;
          HeatFlowBar bar{network_bar,
                          surface_bar,
                          physics.heat,
                          film_of(physics.heat, spells[i].of),
                          physics.dies,
                          dt_bar,
                          &workpiece.friction_flux};
          reverse_conduct(flow(i),
                          spells[i].parts[s] * spells[i].time,
                          before[i][s].first,
                          before[i][s].second,
                          workpiece.temperature,
                          workpiece.skin,
                          bar);
          time_bar += spells[i].parts[s] * dt_bar;
        }
        if (earlier)
          reverse_thermal_surface_after(earlier->under_press,
                                        view(),
                                        surface(i),
                                        process.heat.gap,
                                        surface_bar,
                                        start_bar,
                                        workpiece.X,
                                        physics.dies);
        else
          reverse_thermal_surface(view(),
                                  surface(i),
                                  reach_of(spells[i], process.heat, at),
                                  surface_bar,
                                  workpiece.X,
                                  physics.dies,
                                  velocity && !velocity->empty() ? &workpiece.velocity : nullptr);
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
  };

  ReversibleConduction::ReversibleConduction(const Scene                     &scene,
                                             const NetworkEdges              &edges,
                                             const Process<double>           &process,
                                             const StrokeStep                &at,
                                             const WorkpieceState<3, double> &state,
                                             const TouchedDies               &touching)
      : touching_(touching)
  {
    if (!process.heat.conducts())
      return;
    const auto steps = std::make_shared<Steps>(Steps{scene,
                                                     edges,
                                                     process,
                                                     HalfOfIncrement::first,
                                                     at,
                                                     place_of(HalfOfIncrement::first, at),
                                                     state.X,
                                                     is_first(at) ? no_friction(state) : state.friction_flux,
                                                     touching.first,
                                                     &state.velocity});
    steps->go(state.temperature, state.skin);
    first_ = steps;
  }

  namespace
  {
    bool follows_heat(const Costate &costate)
    {
      return !is_zero(costate.workpiece.temperature) || !is_zero(costate.workpiece.skin) ||
             !is_zero(costate.workpiece.friction_flux);
    }
  } // namespace

  void ReversibleConduction::reverse_after(const NodalVectors<double>      &X,
                                           const WorkpieceState<3, double> &state,
                                           std::vector<Costate>            &costates)
  {
    if (!first_)
      return;
    const Steps &first = *first_;
    Steps        second{first.scene,
                 first.edges,
                 first.process,
                 HalfOfIncrement::second,
                 first.at,
                 place_of(HalfOfIncrement::second, first.at),
                 X,
                 state.friction_flux,
                 touching_.second,
                 nullptr,
                 &first};
    second.go(state.temperature, state.skin);
    start_bars_.assign(costates.size(), ThermalSurfaceBar(first.under_press));
    for (std::size_t j = 0; j < costates.size(); ++j)
      if (follows_heat(costates[j]))
        second.reverse(costates[j], start_bars_[j]);
  }

  void ReversibleConduction::reverse_before(std::vector<Costate> &costates) const
  {
    if (!first_)
      return;
    AssertDimension(start_bars_.size(), costates.size());
    for (std::size_t j = 0; j < costates.size(); ++j)
      if (follows_heat(costates[j]))
      {
        ThermalSurfaceBar start_bar = start_bars_[j];
        first_->reverse(costates[j], start_bar);
        if (is_first(first_->at))
          costates[j].workpiece.friction_flux = no_friction(costates[j].workpiece);
      }
  }
} // namespace retroforge
