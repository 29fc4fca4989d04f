// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/objective_type.h>
#include <retroforge/objective/path_objective.h>
#include <retroforge/objective/smooth_region.h>

#include <optional>

/// @file
/// Folds announce themselves by strain rates that are far higher on a small part of the free surface than
/// elsewhere.
namespace retroforge
{
  /// The free surface's faces of a stage: e of the face's cell, area A, and
  ///   f = prod_die ( 1 - prod_node w(delta) ),
  /// the part that touches no die, w the friction ramp of the increment; both times the region's weight at
  /// the face's centre.
  class FoldIntegrals
  {
  public:
    /// @param exponent  alpha >= 1 of e^alpha  @throws Error
    FoldIntegrals(double exponent, const std::optional<SmoothRegion> &region);

    /// Returns this rank's part of  int e^alpha dS [mm^2/s^alpha],  int dS [mm^2],  and the mean over all
    /// cells of e [1/s] (each cell counts alike, as in the source).
    template <typename Number>
    std::vector<Number> operator()(const EquilibriumView<Number> &view) const;

    /// Adds the derivatives of weights·integrals; those in the ramps go to ContactSetBar.
    void reverse(const EquilibriumView<double> &view,
                 const std::vector<double>     &weights,
                 EquilibriumBar                &bar) const;

  private:
    double                      exponent_;
    std::optional<SmoothRegion> region_;
  };

  /// Fold indicator [mm^2 s^(1-alpha)],  sum_i dt_i int_free e^alpha dS.  @cite Laroussi2003, Eq. (103)-(104)
  class FoldObjective : public PathObjectiveOf<FoldObjective>
  {
  public:
    static constexpr unsigned int n_terms = 1;

    explicit FoldObjective(const double exponent, const std::optional<SmoothRegion> &region = {})
        : exponent_(exponent), fold_(exponent, region)
    {
    }

    std::string name() const override { return "fold"; }
    std::string unit() const override;

    void reverse_integrals(const EquilibriumView<double> &view,
                           const std::vector<double>     &weights,
                           EquilibriumBar                &bar) const override
    {
      fold_.reverse(view, weights, bar);
    }

    template <typename Number>
    std::vector<Number> compute_integrals(const EquilibriumView<Number> &view) const
    {
      return fold_(view);
    }

    template <typename Number>
    std::vector<Number> terms(const PathRow<Number> &row, double) const
    {
      return {Number(row.dt * row.integrals[0])};
    }

    template <typename Number>
    Number combine(const std::vector<Number> &sums, double) const
    {
      return sums[0];
    }

  private:
    double        exponent_;
    FoldIntegrals fold_;
  };

  /// Dimensionless fold indicator: the mean over time of
  ///   ( 1/S int_free (e/e_mean)^alpha dS )^(1/alpha).
  /// Near 1 for a uniform flow. Increments without free surface or flow count as zero.
  /// @cite Laroussi2003, Eq. (105)
  class DimensionlessFold : public PathObjectiveOf<DimensionlessFold>
  {
  public:
    static constexpr unsigned int n_terms = 2;

    explicit DimensionlessFold(const double exponent, const std::optional<SmoothRegion> &region = {})
        : exponent_(exponent), fold_(exponent, region)
    {
    }

    std::string name() const override { return "dimensionless fold"; }
    std::string unit() const override { return "none"; }

    void reverse_integrals(const EquilibriumView<double> &view,
                           const std::vector<double>     &weights,
                           EquilibriumBar                &bar) const override
    {
      fold_.reverse(view, weights, bar);
    }

    template <typename Number>
    std::vector<Number> compute_integrals(const EquilibriumView<Number> &view) const
    {
      return fold_(view);
    }

    template <typename Number>
    std::vector<Number> terms(const PathRow<Number> &row, double) const
    {
      const auto &a = row.integrals;
      if (value_of(a[1]) <= 0. || value_of(a[2]) <= 0.)
        return {Number(0.), row.dt};
      return {Number(row.dt * power(Number(a[0] / a[1]), Number(1. / exponent_)) / a[2]), row.dt};
    }

    template <typename Number>
    Number combine(const std::vector<Number> &sums, double) const
    {
      return value_of(sums[1]) > 0. ? Number(sums[0] / sums[1]) : Number(0.);
    }

  private:
    double        exponent_;
    FoldIntegrals fold_;
  };

  /// Return the types of these objectives, as parameter files offer them.
  Choice<ObjectiveType>::Maker fold_type();
  Choice<ObjectiveType>::Maker dimensionless_fold_type();
} // namespace retroforge
