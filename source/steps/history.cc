// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/strain_history.h>
#include <retroforge/steps/damage.h>
#include <retroforge/steps/friction_heat.h>
#include <retroforge/steps/history.h>
#include <retroforge/steps/warming.h>

namespace retroforge
{
  template <typename Number>
  void add_history(const EquilibriumView<Number> &view, const Number &dt, WorkpieceState<3, Number> &state)
  {
    const Discretization<3> &discretization = view.stage.scene.discretization;
    state.strain =
      accumulate_strain<Number>(discretization, view.stage.X, view.W, Number(view.weight * dt), state.strain);
    complete_entries(discretization.cells(), state.strain.data(), 1);
    if (!state.temperature.empty())
      add_warming(view, dt, state.temperature);
    if (view.stage.physics.heat.conducts())
    {
      add_friction_heat(view, dt, state.temperature);
      if (!state.friction_flux.empty())
        add_friction_flux(view, state.friction_flux);
    }
    if (!state.damage.empty())
      add_damage(view, dt, state.damage);
  }

  template void add_history(const EquilibriumView<double> &, const double &, WorkpieceState<3, double> &);
  template void add_history(const EquilibriumView<Dual> &, const Dual &, WorkpieceState<3, Dual> &);

  void reverse_history(const EquilibriumView<double>   &view,
                       const double                     dt,
                       const WorkpieceState<3, double> &costate,
                       EquilibriumBar                  &bar)
  {
    if (!is_zero(costate.temperature))
    {
      reverse_add_warming(view, dt, costate.temperature, bar);
      if (view.stage.physics.heat.conducts())
        reverse_add_friction_heat(view, dt, costate.temperature, bar);
    }
    if (!is_zero(costate.friction_flux))
      reverse_add_friction_flux(view, costate.friction_flux, bar);
    if (!is_zero(costate.damage))
      reverse_add_damage(view, dt, costate.damage, bar);
    if (is_zero(costate.strain))
      return;
    bar.physics.dt += view.weight * reverse_accumulate_strain(view.stage.scene.discretization,
                                                              view.stage.X,
                                                              view.W,
                                                              view.weight * dt,
                                                              costate.strain,
                                                              bar.W,
                                                              bar.X);
  }

  namespace
  {
    /// The same with another weight in integrals.
    template <typename Number>
    EquilibriumView<Number> weighted(const EquilibriumView<Number> &view, const double weight)
    {
      return {view.stage, view.W, view.active, weight};
    }
  } // namespace

  template <typename Number>
  StageHistory<Number>::StageHistory(const Scene                     &scene,
                                     const Process<Number>           &process,
                                     const WorkpieceState<3, Number> &state)
      : scene_(scene), initial_(process.material.initial)
  {
    if (!process.material.depends_on_state())
      return;
    states_.push_back(without_motion(state));
    states_.back().damage.clear(); // no law follows these
    states_.back().friction_flux.clear();
    points_.push_back(point_states(scene.mesh, initial_, states_.back()));
  }

  template <typename Number>
  const std::vector<PointState<Number>> &StageHistory<Number>::points(const unsigned int stage) const
  {
    if (!is_needed())
      return initial_points<Number>();
    AssertIndexRange(stage, points_.size());
    return points_[stage];
  }

  template <typename Number>
  void StageHistory<Number>::add(const Scheme                  &scheme,
                                 const unsigned int             r,
                                 const EquilibriumView<Number> &view,
                                 const Number                  &dt)
  {
    if (!is_needed() || r + 1 == scheme.n_stages())
      return;
    AssertDimension(points_.size(), r + 1);
    states_.resize(scheme.n_stages(), states_.front());
    for (unsigned int s = r + 1; s < scheme.n_stages(); ++s)
      if (scheme.a[s][r] != 0.)
        add_history(weighted(view, scheme.a[s][r]), dt, states_[s]);
    points_.push_back(point_states(scene_.mesh, initial_, states_[r + 1]));
  }

  template class StageHistory<double>;
  template class StageHistory<Dual>;

  bool StageHistoryBar::reverse_add(const Scheme                  &scheme,
                                    const unsigned int             r,
                                    const EquilibriumView<double> &view,
                                    const double                   dt,
                                    EquilibriumBar                &bar) const
  {
    bool any = false;
    for (const auto &[s, costate] : of_stage_)
      if (s > r && scheme.a[s][r] != 0.)
      {
        reverse_history(weighted(view, scheme.a[s][r]), dt, costate, bar);
        any = true;
      }
    return any;
  }

  void StageHistoryBar::take(const Scene         &scene,
                             const bool           warms,
                             const unsigned int   s,
                             RankSum<PhysicsBar> &physics)
  {
    std::vector<PointState<double>> part = std::exchange(physics.part().points, {});
    part.resize(scene.mesh.n_cells());
    const RankSum<std::vector<PointState<double>>> bar(std::move(part), scene.discretization.comm());
    WorkpieceState<3, double>                      costate = zero_costate<3>(0, scene.mesh.n_cells());
    if (warms)
      costate.temperature.assign(scene.mesh.n_nodes(), 0.);
    PointState<double> initial_bar;
    reverse_point_states(scene.mesh, bar.complete(), initial_bar, costate);
    physics.add_once([&](PhysicsBar &once) { add_numbers(initial_bar, once.material.initial); });
    of_stage_.emplace(s, std::move(costate));
  }

  void StageHistoryBar::add_to(WorkpieceState<3, double> &costate) const
  {
    for (const auto &[s, of_stage] : of_stage_)
      add_numbers(of_stage, costate);
  }
} // namespace retroforge
