// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/effort.h>
#include <retroforge/objective/objective_type.h>
#include <retroforge/objective/path_objective.h>
#include <retroforge/objective/smooth_region.h>

#include <optional>

namespace retroforge
{
  enum class Wear
  {
    mean,   ///< over the area of the contact [mJ/mm^2]
    total,  ///< of the die [mJ]
    largest ///< along the die [mJ/mm^2]: LargestWear (largest_wear.h)
  };

  /// Wear of a die by Archard's law, the work of pressing times sliding: the volume that is worn off is it, times
  /// the coefficient of wear, over the hardness of the die.
  ///   total  W = sum_i dt_i sum_k w_k N_k |dv_k|,
  ///   mean   W / A,   A = sum_i dt_i A_i^2 / sum_i dt_i A_i,   A_i = sum_k w_k r_k S_k,
  /// k the contact points in reach of the die, N_k the force that presses one, |dv| = sqrt(dv^2 + v_0^2) - v_0 its
  /// slip, which is zero where it sticks; r_k the friction ramp and S_k a third of the surface at a node: A_i
  /// is the area in contact, and A its mean over the path weighted with itself, so that what comes before the contact
  /// does not count. dt_i is the part of increment i in a window, w_k the weight of a region. Forces are as the
  /// equilibrium has them; vertices of quadratic velocities may pull, and then count as such. Zero before any contact.
  /// @cite Archard1953
  class DieWear : public PathObjectiveOf<DieWear>
  {
  public:
    static constexpr unsigned int n_terms = 3;

    /// @param wear  mean or total
    DieWear(unsigned int                       die,
            Wear                               wear,
            const PathWindow                  &window = {},
            const std::optional<SmoothRegion> &region = {});

    std::string name() const override { return "die wear"; }
    std::string unit() const override { return wear_ == Wear::mean ? "mJ/mm^2" : "mJ"; }

    /// Returns the total [mJ], and A [mm^2].
    std::map<std::string, double> details(const PathRows<double> &rows) const override;

    void reverse_integrals(const EquilibriumView<double> &view,
                           const std::vector<double>     &weights,
                           EquilibriumBar                &bar) const override;

    template <typename Number>
    std::vector<Number> compute_integrals(const EquilibriumView<Number> &view) const;

    template <typename Number>
    std::vector<Number> terms(const PathRow<Number> &row, double) const
    {
      const Number  time = window_.time_inside(row);
      const Number &work = row.integrals[0], &area = row.integrals[1];
      return {Number(time * work), Number(time * area), Number(time * area * area)};
    }

    template <typename Number>
    Number combine(const std::vector<Number> &sums, double) const
    {
      if (wear_ == Wear::total)
        return sums[0];
      return value_of(sums[2]) > 0. ? Number(sums[0] * sums[1] / sums[2]) : Number(0.);
    }

  private:
    unsigned int                die_;
    Wear                        wear_;
    PathWindow                  window_;
    std::optional<SmoothRegion> region_;
  };

  /// Returns the type of this objective, as parameter files offer it.
  Choice<ObjectiveType>::Maker die_wear_type();
} // namespace retroforge
