// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/final_objective.h>
#include <retroforge/objective/objective_type.h>

namespace retroforge
{
  /// Volume of the workpiece at the end [mm^3]: what the billet should keep, or a price for material.
  class VolumeObjective : public FinalObjectiveOf<VolumeObjective>
  {
  public:
    std::string name() const override { return "volume"; }
    std::string unit() const override { return "mm^3"; }

    void
    reverse_integrals(const FinalView<double> &view, const std::vector<double> &weights, FinalBar &bar) const;

    template <typename Number>
    std::vector<Number> compute_integrals(const FinalView<Number> &view) const;

    template <typename Number>
    Number combine(const std::vector<Number> &integrals) const
    {
      return integrals[0];
    }
  };

  /// Returns the volume of cell c, which this rank visits.
  template <typename Number>
  Number cell_volume(const FinalView<Number> &view, CellIndex c);

  /// Adds volume_bar times the derivatives of cell_volume to X_bar.
  void reverse_cell_volume(const FinalView<double> &view,
                           CellIndex                c,
                           double                   volume_bar,
                           NodalVectors<double>    &X_bar);

  /// Returns the type of this objective, as parameter files offer it.
  Choice<ObjectiveType>::Maker volume_type();
} // namespace retroforge
