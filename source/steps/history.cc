// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/strain_history.h>
#include <retroforge/steps/history.h>

namespace retroforge
{
  template <typename Number>
  void add_history(const EquilibriumView<Number> &view, const Number &dt, WorkpieceState<3, Number> &state)
  {
    state.strain = accumulate_strain<Number>(
      view.stage.scene.discretization, view.stage.X, view.W, Number(view.weight * dt), state.strain);
  }

  template <typename Number>
  void complete_history(const Discretization<3> &discretization, WorkpieceState<3, Number> &state)
  {
    complete_entries(discretization.cells(), state.strain.data(), 1);
  }

#define RETROFORGE_INSTANTIATE(Number)                                                                     \
  template void add_history(const EquilibriumView<Number> &, const Number &, WorkpieceState<3, Number> &); \
  template void complete_history(const Discretization<3> &, WorkpieceState<3, Number> &);
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE

  void reverse_history(const EquilibriumView<double>   &view,
                       const double                     dt,
                       const WorkpieceState<3, double> &costate,
                       EquilibriumBar                  &bar)
  {
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
} // namespace retroforge
