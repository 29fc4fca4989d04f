// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/free_nodes.h>
#include <retroforge/objective/objective_type.h>
#include <retroforge/objective/target_surface.h>
#include <retroforge/objective/workpiece_surface.h>

namespace retroforge
{
  /// Volume between the workpiece and the desired shape by double projection [mm^3],
  ///   1/2 ( sum_k |delta_k| S_k  +  sum_l |delta_l| S_l ),
  /// k the nodes of the workpiece's surface, delta_k their distance from the target, S_k a third of the areas
  /// around them; l the vertices of the target, delta_l their distance from the workpiece's surface. All
  /// surface nodes count, those in contact included; or, as in the source, those of the free surface: S_k is
  /// then multiplied with how far the node is free (FreeNodes). |delta| may be rounded to  sqrt(delta^2 +
  /// r^2) - r. Of the target, only what lies in the sector counts that symmetry planes left of the workpiece.
  /// Frozen: closest features, and which points see any. Moves of an open target's rim past the workpiece are
  /// such decisions.  @cite Laroussi2003, Eq. (109), (111)
  class FillingObjective : public FinalObjectiveOf<FillingObjective>
  {
  public:
    /// @param rounding  r [mm]; 0 has a kink where a node lies on the target, with derivative zero at it
    /// @param free      counts nodes of the free surface only
    explicit FillingObjective(TargetSurface                   target,
                              double                          rounding = 0.,
                              const std::optional<FreeNodes> &free     = {});

    std::string  name() const override { return "filling"; }
    std::string  unit() const override { return "mm^3"; }
    unsigned int target_die() const override { return target_.die(); }

    /// Which features the two projections see, and the workpiece's surface at that moment.
    struct Decisions
    {
      std::vector<SeenFeature> by_workpiece; ///< this rank's nodes of the workpiece, features of the target
      std::vector<SeenFeature> by_target; ///< its share of the target's vertices, features of the workpiece
      WorkpieceSurface         workpiece;
      std::vector<Triangle>    target; ///< those of the target that face the model, by their centres
      FreeNodes::Decisions     near;   ///< where free nodes count, what they see of the dies
    };

    /// @throws Error  when the workpiece's surface is folded onto itself (see TriangleSurface)
    Decisions compute_decisions(const FinalView<double> &view) const;

    std::map<std::string, double> parts(const std::vector<double> &integrals) const override
    {
      return {{"workpiece onto target", 0.5 * integrals[0]}, {"target onto workpiece", 0.5 * integrals[1]}};
    }

    /// Returns the two sums, workpiece -> target and target -> workpiece.
    template <typename Number>
    std::vector<Number> compute_integrals(const FinalView<Number> &view, const Decisions &decisions) const;

    template <typename Number>
    Number combine(const std::vector<Number> &integrals, const Decisions &) const
    {
      return 0.5 * (integrals[0] + integrals[1]);
    }

    void reverse_integrals(const FinalView<double>   &view,
                           const Decisions           &decisions,
                           const std::vector<double> &weights,
                           FinalBar                  &bar) const;

  private:
    template <typename Number>
    Number rounded(const Number &delta) const;
    double slope(double delta) const;

    void reverse_by_workpiece(const FinalView<double> &view,
                              const Decisions         &decisions,
                              double                   weight,
                              FinalBar                &bar) const;
    void reverse_by_target(const FinalView<double> &view,
                           const Decisions         &decisions,
                           double                   weight,
                           FinalBar                &bar) const;

    TargetSurface            target_;
    double                   rounding_;
    std::optional<FreeNodes> free_;
  };

  /// Returns the type of this objective, as parameter files offer it.
  Choice<ObjectiveType>::Maker filling_type();
} // namespace retroforge
