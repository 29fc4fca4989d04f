// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/die_sites.h>
#include <retroforge/objective/effort.h>
#include <retroforge/objective/path_objective.h>
#include <retroforge/objective/smooth_region.h>

#include <optional>

namespace retroforge
{
  /// The largest wear along a die, by Archard's law as DieWear has it: at site s of the die (die_sites.h)
  ///   w_s = sum_i dt_i sum_k K(z_s - y_k) w_k N_k |dv_k|   [mJ/mm^2],
  /// y_k the contact points less the die's displacement, and of all of them
  ///   Phi = sum_s w_s^(p+1) / sum_s w_s^p,
  /// a mean below the largest one that sites without wear do not change. Zero before any contact.
  class LargestWear : public PathIntegralsOf<LargestWear>
  {
  public:
    /// @param exponent  p >= 1
    LargestWear(unsigned int                       die,
                DieSites                           sites,
                double                             exponent,
                const PathWindow                  &window = {},
                const std::optional<SmoothRegion> &region = {});

    std::string name() const override { return "die wear"; }
    std::string unit() const override { return "mJ/mm^2"; }

    double value(const PathRows<double> &rows) const override;
    Dual   value(const PathRows<Dual> &rows) const override;

    /// Returns the largest w_s, and its site with the die at its start [mm].
    std::map<std::string, double> details(const PathRows<double> &rows) const override;

    /// Returns w_s at the sites with the die at its start.
    ObjectiveMap map(const PathRows<double> &rows) const override;

    PathRows<double> reverse_value(const PathRows<double> &rows) const override;

    void reverse_integrals(const EquilibriumView<double> &view,
                           const std::vector<double>     &weights,
                           EquilibriumBar                &bar) const override;

    template <typename Number>
    std::vector<Number> compute_integrals(const EquilibriumView<Number> &view) const;

    const DieSites &sites() const { return sites_; }

    /// Returns w_s.
    template <typename Number>
    std::vector<Number> wear(const PathRows<Number> &rows) const;

  private:
    template <typename Number>
    Number mean(const std::vector<Number> &wear) const;

    unsigned int                die_;
    DieSites                    sites_;
    double                      exponent_;
    PathWindow                  window_;
    std::optional<SmoothRegion> region_;
  };
} // namespace retroforge
