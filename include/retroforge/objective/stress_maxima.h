// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/objective_type.h>
#include <retroforge/objective/path_maximum.h>
#include <retroforge/objective/smooth_region.h>

#include <optional>

/// @file
/// The largest stresses within the workpiece over its path.
namespace retroforge
{
  enum class InnerStress
  {
    /// The pressure p of the metal at the nodes, positive in compression; tension counts as zero.
    pressure,
    /// Shear stress k = sqrt(1/2 s:s) of the mean deviator s of a cell: the equivalent stress over sqrt(3), where
    /// metal flows its shear flow stress. The largest shear stress on a plane, (sigma_1 - sigma_3)/2, lies between
    /// sqrt(3)/2 k (in upsetting and tension) and k (in shear).
    shear
  };

  /// Smooth maximum of a stress x over volume and time (PathMaximumOf), places weighted with w_l V_l: l the corners of cells,
  /// each with a quarter of their volume, or the cells; w_l the weight of a region, 1 without one.
  class StressMaximum : public PathMaximumOf<StressMaximum>
  {
  public:
    /// @param exponent, reference  of PathMaximumOf   @throws Error
    StressMaximum(InnerStress                        stress,
                  double                             exponent,
                  double                             reference,
                  const PathWindow                  &window = {},
                  const std::optional<SmoothRegion> &region = {});

    std::string name() const override;

    /// Returns the largest stress of an increment in window and region, the mean of those of its stages.
    std::map<std::string, double> details(const PathRows<double> &rows) const override;

    void reverse_integrals(const EquilibriumView<double> &view,
                           const std::vector<double>     &weights,
                           EquilibriumBar                &bar) const override;

    /// The two sums, and the largest stress, which has no derivative.
    template <typename Number>
    std::vector<Number> compute_integrals(const EquilibriumView<Number> &view) const;

  private:
    InnerStress                 stress_;
    std::optional<SmoothRegion> region_;
  };

  /// Return the types of these objectives, as parameter files offer them.
  Choice<ObjectiveType>::Maker largest_hydrostatic_pressure_type();
  Choice<ObjectiveType>::Maker largest_shear_type();
} // namespace retroforge
