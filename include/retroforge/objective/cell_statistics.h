// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/final_objective.h>
#include <retroforge/objective/objective_type.h>
#include <retroforge/objective/smooth_maximum.h>

/// @file
/// Statistics of what the metal went through, one number in each cell at the end, over the volume there: the
/// deformation of the workpiece, its mean, evenness and maximum, and its damage. Dimensionless.
namespace retroforge
{
  enum class CellQuantity
  {
    strain, ///< accumulated equivalent strain q
    damage  ///< D (steps/damage.h)
  };

  enum class CellStatistic
  {
    mean,     ///< int x / V
    variance, ///< int (x - mean)^2 / V; its square root has no derivative where all is even
    largest   ///< smooth
  };

  /// Statistic of a quantity x, each cell weighted with its volume at X_N.
  class CellStatistics : public FinalObjectiveOf<CellStatistics>
  {
  public:
    /// @param smooth  of the largest, and else ignored   @throws Error
    CellStatistics(CellQuantity quantity, CellStatistic statistic, const SmoothMaximum &smooth = {});

    std::string name() const override;
    std::string unit() const override { return "none"; }

    /// The reference to which values are taken: the mean for mean and variance (what is small would else be
    /// a difference of large numbers), the true maximum for the largest. Phi does not depend on it; frozen.
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
    template <typename Number>
    const std::vector<Number> &values(const FinalView<Number> &view) const
    {
      Assert(quantity_ == CellQuantity::strain || view.damage != nullptr,
             dealii::ExcMessage("the damage is not followed"));
      return quantity_ == CellQuantity::strain ? view.q : *view.damage;
    }

    /// Returns the two functions of a cell's value that are integrated; slopes() returns their derivatives.
    template <typename Number>
    std::array<Number, 2> integrands(const Number &x, double reference) const;
    std::array<double, 2> slopes(double x, double reference) const;

    CellQuantity  quantity_;
    CellStatistic statistic_;
    SmoothMaximum smooth_;
  };

  /// Return the types of these objectives, as parameter files offer them.
  Choice<ObjectiveType>::Maker mean_strain_type();
  Choice<ObjectiveType>::Maker strain_variance_type();
  Choice<ObjectiveType>::Maker maximum_strain_type();
  Choice<ObjectiveType>::Maker damage_type();
} // namespace retroforge
