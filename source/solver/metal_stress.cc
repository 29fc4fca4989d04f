// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/element_pairs.h>
#include <retroforge/element/cell_geometry.templates.h>
#include <retroforge/solver/metal_stress.h>

namespace retroforge
{
  template <typename Number>
  CellStress<Number> cell_stress(const EquilibriumView<Number> &view, const CellIndex c)
  {
    const Discretization<3> &discretization = view.stage.scene.discretization;
    CellStress<Number>       stress;
    stress.law = view.stage.law(c);
    dispatch_element(discretization, [&](const auto pair) {
      const auto geometry = cell_geometry(pair.positions(discretization, view.stage.X, c));
      const auto w        = pair.on_cell(discretization, view.W, c);
      stress.s            = cell_deviatoric_stress(geometry, w, stress.law);
      stress.rate         = cell_strain_rate(geometry, w);
      stress.p            = Number(0.);
      for (const Number &p : w.P)
        stress.p += p / double(w.P.size());
    });
    return stress;
  }

  template CellStress<double> cell_stress(const EquilibriumView<double> &, CellIndex);
  template CellStress<Dual>   cell_stress(const EquilibriumView<Dual> &, CellIndex);

  void reverse_cell_stress(const EquilibriumView<double> &view,
                           const CellIndex                c,
                           const CellStress<double>      &stress_bar,
                           EquilibriumBar                &bar)
  {
    const Discretization<3>  &discretization = view.stage.scene.discretization;
    const MaterialLaw<double> law            = view.stage.law(c);
    Symmetric<double>         s_bar          = stress_bar.s; // as a tensor, whose shears stand twice
    for (unsigned int k = 3; k < 6; ++k)
      s_bar[k] *= 0.5;
    dispatch_element(discretization, [&](const auto pair) {
      const auto geometry = cell_geometry(pair.positions(discretization, view.stage.X, c));
      const auto w        = pair.on_cell(discretization, view.W, c);
      auto       w_bar    = pair.no_values();
      auto       of_cell  = reverse_cell_deviatoric_stress(geometry, w, law, s_bar, w_bar);
      reverse_cell_strain_rate(geometry, w, stress_bar.rate, w_bar, of_cell.X);
      for (double &p : w_bar.P)
        p += stress_bar.p / double(w_bar.P.size());
      pair.add(discretization, w_bar, c, bar.W);
      add_to_positions(discretization, of_cell.X, c, bar.X);
      add_numbers(stress_bar.law, of_cell.law);
      reverse_law(view.stage, c, of_cell.law, bar.physics);
    });
  }
} // namespace retroforge
