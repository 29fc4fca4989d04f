// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/objective_type.h>
#include <retroforge/objective/target_surface.h>

/// @file
/// How far the final surface is from the one wanted, as a mean square weighted with the surface.
namespace retroforge
{
  /// sum_k S_k delta_k^2 / sum_k S_k  [mm^2]  over the nodes of the workpiece's surface that see the target,
  /// S_k a third of the areas around them. Smooth where the surfaces meet. Frozen: the closest features.
  class ShapeDistance : public FinalObjectiveOf<ShapeDistance>
  {
  public:
    explicit ShapeDistance(TargetSurface target) : target_(std::move(target)) {}

    std::string  name() const override { return "shape distance"; }
    std::string  unit() const override { return "mm^2"; }
    unsigned int target_die() const override { return target_.die(); }

    /// This rank's nodes of the workpiece, features of the target.
    using Decisions = std::vector<SeenFeature>;
    Decisions compute_decisions(const FinalView<double> &view) const
    {
      return target_.seen_by_workpiece(view);
    }

    template <typename Number>
    std::vector<Number> compute_integrals(const FinalView<Number> &view,
                                          const Decisions         &seen_features) const;

    /// 0 when no node sees the target.
    template <typename Number>
    Number combine(const std::vector<Number> &b, const Decisions &) const
    {
      return value_of(b[0]) > 0. ? Number(b[1] / b[0]) : Number(0.);
    }

    void reverse_integrals(const FinalView<double>   &view,
                           const Decisions           &seen_features,
                           const std::vector<double> &weights,
                           FinalBar                  &bar) const;

  private:
    TargetSurface target_;
  };

  /// Returns the type of this objective, as parameter files offer it.
  Choice<ObjectiveType>::Maker shape_distance_type();
} // namespace retroforge
