// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/rank_sum.h>
#include <retroforge/solver/equilibrium.h>
#include <retroforge/steps/point_states.h>
#include <retroforge/steps/process.h>
#include <retroforge/steps/scheme.h>

#include <deque>
#include <map>

/// @file
/// The step that adds to the history of the metal what the solved stages of an increment of time dt give it:
/// the strain  q' = q + dt sum_s b_s e(Y_s, W_s)  of each cell (discretization/strain_history.h), and the temperature
/// of each node where the metal warms (steps/warming.h), what friction makes of heat (steps/friction_heat.h), the damage of each cell where it is followed (steps/damage.h).
namespace retroforge
{
  /// Returns the workpiece before the stroke: metal without history, at the temperature that the process gives it
  /// where it warms.
  template <typename Number>
  WorkpieceState<3, Number>
  workpiece_before(const Process<Number> &process, NodalVectors<Number> X, const std::size_t n_cells)
  {
    auto state = initial_state<3>(std::move(X), n_cells);
    if (process.heat.warms())
      state.temperature.assign(state.X.size(), process.material.initial.temperature);
    if (process.heat.conducts())
    {
      state.skin = NodeSkins<Number>::none(state.X.size(), process.dies.size());
      state.friction_flux.assign(state.X.size(), Number(0.));
    }
    if (process.material.is_damaged())
      state.damage.assign(n_cells, Number(0.));
    return state;
  }

  /// Adds one stage, weighted as its view says; on dual numbers the tangent. Collective.
  template <typename Number>
  void add_history(const EquilibriumView<Number> &view, const Number &dt, WorkpieceState<3, Number> &state);

  /// Reverse of add_history(): adds to the derivatives in the stage's unknowns and positions, and in dt, this
  /// rank's part. The costate of the state after is that of the state before.
  void reverse_history(const EquilibriumView<double>   &view,
                       double                           dt,
                       const WorkpieceState<3, double> &costate,
                       EquilibriumBar                  &bar);

  /// The metal as the stages of an increment find it, where laws depend on its state:
  ///   q_s = q + dt sum_(r<s) a_sr e(Y_r, W_r),
  /// explicit, so that the equilibrium of a stage keeps its potential.
  template <typename Number>
  class StageHistory
  {
  public:
    /// @param state  at the start of the increment
    StageHistory(const Scene &scene, const Process<Number> &process, const WorkpieceState<3, Number> &state);

    /// Tells whether stages leave anything to later ones: else add() need not be called.
    bool is_needed() const { return !states_.empty(); }

    /// Returns the state of the metal in each cell at a stage, those before having been added; where laws do
    /// not depend on it, none.
    const std::vector<PointState<Number>> &points(unsigned int stage) const;

    /// Adds what stage r leaves to those that follow. Collective.
    void add(const Scheme &scheme, unsigned int r, const EquilibriumView<Number> &view, const Number &dt);

  private:
    const Scene                                &scene_;
    PointState<Number>                          initial_;
    std::vector<WorkpieceState<3, Number>>      states_; ///< of the stages so far, without motion
    std::deque<std::vector<PointState<Number>>> points_; ///< stages refer to them while others are added
  };

  /// Reverse of StageHistory for one scalar, stage by stage from the last.
  class StageHistoryBar
  {
  public:
    /// Adds what the stages after stage r take from it: to the derivatives in its unknowns and positions, and
    /// in dt, this rank's part.
    /// @return whether they take anything
    bool reverse_add(const Scheme                  &scheme,
                     unsigned int                   r,
                     const EquilibriumView<double> &view,
                     double                         dt,
                     EquilibriumBar                &bar) const;

    /// Takes the derivatives in the state of the metal at stage s from this rank's part of `physics`.
    /// Collective.
    void take(const Scene &scene, bool warms, unsigned int s, RankSum<PhysicsBar> &physics);

    /// Adds the derivatives in the state at the start of the increment.
    void add_to(WorkpieceState<3, double> &costate) const;

  private:
    std::map<unsigned int, WorkpieceState<3, double>> of_stage_;
  };
} // namespace retroforge
