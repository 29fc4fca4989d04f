// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/effort.h>
#include <retroforge/objective/objective_type.h>
#include <retroforge/objective/path_objective.h>
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

  /// Smooth maximum of a stress x over volume and time [MPa],
  ///   ( sum_i dt_i sum_l w_l V_l x_l^gamma / sum_i dt_i sum_l w_l V_l )^(1/gamma),
  /// l the corners of cells, each with a quarter of their volume, or the cells; dt_i the part of increment i
  /// in a window; w_l the weight of a region, 1 without one. Zero where nothing of the metal is in the region.
  class StressMaximum : public PathObjectiveOf<StressMaximum>
  {
  public:
    static constexpr unsigned int n_terms = 2;

    /// @param exponent   gamma >= 1, 10 to 50 for a maximum
    /// @param reference  a stress of the expected size, so that x^gamma neither overflows nor vanishes: it cancels
    /// [MPa]   @throws Error
    StressMaximum(InnerStress                        stress,
                  double                             exponent,
                  double                             reference,
                  const PathWindow                  &window = {},
                  const std::optional<SmoothRegion> &region = {});

    std::string name() const override;
    std::string unit() const override { return "MPa"; }

    /// Returns the largest stress of an increment in window and region, the mean of those of its stages.
    std::map<std::string, double> details(const PathRows<double> &rows) const override;

    void reverse_integrals(const EquilibriumView<double> &view,
                           const std::vector<double>     &weights,
                           EquilibriumBar                &bar) const override;

    /// The two sums, and the largest stress, which has no derivative.
    template <typename Number>
    std::vector<Number> compute_integrals(const EquilibriumView<Number> &view) const;

    template <typename Number>
    std::vector<Number> terms(const PathRow<Number> &row, double) const
    {
      const Number time = window_.time_inside(row);
      return {Number(time * row.integrals[0]), Number(time * row.integrals[1])};
    }

    template <typename Number>
    Number combine(const std::vector<Number> &sums, double) const
    {
      if (value_of(sums[0]) <= 0.)
        return Number(0.);
      return reference_ * power(Number(sums[0] / sums[1]), Number(1. / exponent_));
    }

  private:
    template <typename Number>
    Number weight(const Vector3<Number> &x) const
    {
      return region_ ? (*region_)(x) : Number(1.);
    }

    InnerStress                 stress_;
    double                      exponent_, reference_;
    PathWindow                  window_;
    std::optional<SmoothRegion> region_;
  };

  /// Return the types of these objectives, as parameter files offer them.
  Choice<ObjectiveType>::Maker largest_hydrostatic_pressure_type();
  Choice<ObjectiveType>::Maker largest_shear_type();
} // namespace retroforge
