// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/final_objective.h>
#include <retroforge/objective/objective_type.h>
#include <retroforge/objective/smooth_maximum.h>

/// @file
/// Statistics of the deformation of the workpiece, its mean, evenness and maximum: functions of the
/// accumulated equivalent strain q_N over the final volume, each cell weighted with its volume at X_N.
/// Dimensionless.
namespace retroforge
{
  enum class StrainStatistic
  {
    mean,     ///< int q / V
    variance, ///< int (q - mean)^2 / V; its square root has no derivative where all is even
    maximum   ///< smooth
  };

  class StrainObjective : public FinalObjectiveOf<StrainObjective>
  {
  public:
    /// @param smooth  of the maximum, and else ignored
    explicit StrainObjective(StrainStatistic statistic, const SmoothMaximum &smooth = {});

    std::string name() const override;
    std::string unit() const override { return "none"; }

    /// The reference to which strains are taken: the mean for mean and variance (what is small would else be
    /// a difference of large numbers), the true maximum for the maximum. Phi does not depend on it; frozen.
    struct Decisions
    {
      double reference;
    };
    Decisions compute_decisions(const FinalView<double> &view) const;

    /// Returns the true maximum beside the smooth one.
    std::map<std::string, double> details(const std::vector<double> &,
                                          const FinalDecisions &decisions) const override;

    template <typename Number>
    std::vector<Number> compute_integrals(const FinalView<Number> &view, const Decisions &decisions) const;
    template <typename Number>
    Number combine(const std::vector<Number> &integrals, const Decisions &decisions) const;

    void reverse_integrals(const FinalView<double>   &view,
                           const Decisions           &decisions,
                           const std::vector<double> &weights,
                           FinalBar                  &bar) const;

  private:
    /// Returns the two functions of a cell's strain that are integrated; slopes() returns their derivatives.
    template <typename Number>
    std::array<Number, 2> integrands(const Number &q, double reference) const;
    std::array<double, 2> slopes(double q, double reference) const;

    StrainStatistic statistic_;
    SmoothMaximum   smooth_;
  };

  /// Return the types of these objectives, as parameter files offer them.
  Choice<ObjectiveType>::Maker mean_strain_type();
  Choice<ObjectiveType>::Maker strain_variance_type();
  Choice<ObjectiveType>::Maker maximum_strain_type();
} // namespace retroforge
