// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/objective_type.h>
#include <retroforge/objective/sector.h>
#include <retroforge/objective/target_surface.h>
#include <retroforge/objective/workpiece_surface.h>

namespace retroforge
{
  /// The region that material should fill: within a closed surface (the desired shape, normals outwards), or
  /// in front of a die's face.
  enum class Cavity
  {
    within,
    in_front
  };

  /// Volume of a cavity that the workpiece does not reach [mm^3], by samples on a grid:
  ///   sum_g dV H(c_g) H(u_g),   H(x) = 1 - w(x + l/2),
  /// c_g the depth of sample g in the cavity, u_g its distance from the workpiece, both > 0 where it counts,
  /// and H a step smoothed over the layer l (w the smooth FrictionRamp of width l). Symmetric about the
  /// surfaces, so the layer's error is of second order in it, and a plane has none but that of the grid.
  ///
  /// Unlike the double projection it is a volume also where both surfaces are far apart. Samples lie in the
  /// target's region, whose sides cut sharply, or around the whole target if it has none. Of both, only the
  /// sector counts that symmetry planes left of the workpiece.
  /// Frozen: the samples, those that count, and their closest features.
  class UnfilledVolume : public FinalObjectiveOf<UnfilledVolume>
  {
  public:
    /// @param n_samples  along the longest edge of the grid
    /// @param layer      l, in spacings of the samples: at least 1, or they would jump
    /// @throws Error
    UnfilledVolume(TargetSurface target, Cavity cavity, unsigned int n_samples, double layer = 2.);

    std::string  name() const override { return "unfilled volume"; }
    std::string  unit() const override { return "mm^3"; }
    unsigned int target_die() const override { return target_.die(); }

    struct Sample
    {
      Vec3       x;
      double     volume;            ///< volume that the sample stands for, in the sector [mm^3]
      DieFeature target, workpiece; ///< a target of none: deep in a cavity within
    };

    /// The workpiece's surface at that moment, and what of the grid counts.
    struct Decisions
    {
      double              width; ///< l [mm]
      WorkpieceSurface    workpiece;
      std::vector<Sample> samples; ///< of this rank's share
    };

    /// @throws Error  when the workpiece's surface is folded onto itself
    Decisions compute_decisions(const FinalView<double> &view) const;

    template <typename Number>
    std::vector<Number> compute_integrals(const FinalView<Number> &view, const Decisions &decisions) const;

    template <typename Number>
    Number combine(const std::vector<Number> &integrals, const Decisions &) const
    {
      return integrals[0];
    }

    void reverse_integrals(const FinalView<double>   &view,
                           const Decisions           &decisions,
                           const std::vector<double> &weights,
                           FinalBar                  &bar) const;

  private:
    struct Grid
    {
      std::array<unsigned int, 3> n;
      Vec3                        origin, spacing;
      double                      width; ///< l

      unsigned int n_samples() const { return n[0] * n[1] * n[2]; }
      Vec3         sample(unsigned int g) const;
    };

    Grid   make_grid(const FinalView<double> &view) const;
    double sign() const { return cavity_ == Cavity::within ? -1. : 1.; }

    TargetSurface target_;
    Cavity        cavity_;
    unsigned int  n_samples_;
    double        layer_; ///< in spacings
  };

  /// Returns the type of this objective, as parameter files offer it.
  Choice<ObjectiveType>::Maker unfilled_volume_type();
} // namespace retroforge
