// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/triangle_surface.h>
#include <retroforge/objective/final_objective.h>
#include <retroforge/objective/objective_type.h>

#include <map>
#include <string>
#include <vector>

namespace retroforge
{
  enum class RadiusStatistic
  {
    mean,    ///< sum_k S_k r_k / sum_k S_k  [mm]: of a bore or a bulged side, as a gauge finds it
    variance ///< min_R sum_k S_k (r_k - R)^2 / sum_k S_k  [mm^2]: the distance from a straight cylinder
  };

  /// The radius of named patches: r_k the distance of node k from an axis, S_k a third of the areas of the
  /// patches' faces at it. Of the variance, the radius R of the cylinder that fits best is the mean: what
  /// barrels least has the least of it.
  class RadiusObjective : public FinalObjectiveOf<RadiusObjective>
  {
  public:
    /// @param patches  of the workpiece     @param axis  direction, of any length
    /// @throws Error  for no axis or no patches
    RadiusObjective(RadiusStatistic          statistic,
                    std::vector<std::string> patches,
                    const Vec3              &point,
                    const Vec3              &axis);

    std::string name() const override
    {
      return statistic_ == RadiusStatistic::mean ? "mean radius" : "cylinder distance";
    }
    std::string unit() const override { return statistic_ == RadiusStatistic::mean ? "mm" : "mm^2"; }

    /// The radius from which others are measured, to keep digits: Phi does not depend on it.
    struct Decisions
    {
      double reference; ///< [mm]
    };
    Decisions compute_decisions(const FinalView<double> &view) const;

    /// Returns the mean radius [mm].
    std::map<std::string, double> details(const std::vector<double> &b,
                                          const FinalDecisions      &decisions) const override
    {
      return {{"radius [mm]", std::any_cast<Decisions>(decisions).reference + b[1] / b[0]}};
    }

    template <typename Number>
    std::vector<Number> compute_integrals(const FinalView<Number> &view, const Decisions &decisions) const;

    template <typename Number>
    Number combine(const std::vector<Number> &b, const Decisions &decisions) const
    {
      const Number mean = b[1] / b[0];
      return statistic_ == RadiusStatistic::mean ? Number(decisions.reference + mean)
                                                 : Number(b[2] / b[0] - mean * mean);
    }

    void reverse_integrals(const FinalView<double>   &view,
                           const Decisions           &decisions,
                           const std::vector<double> &weights,
                           FinalBar                  &bar) const;

  private:
    std::vector<Triangle> triangles(const TetMesh &mesh) const;
    template <typename Number>
    Vector3<Number> from_axis(const Vector3<Number> &x) const;

    RadiusStatistic          statistic_;
    std::vector<std::string> patches_;
    Vec3                     point_, axis_;
  };

  /// Return the types of these objectives, as parameter files offer them.
  Choice<ObjectiveType>::Maker cylinder_distance_type();
  Choice<ObjectiveType>::Maker mean_radius_type();
} // namespace retroforge
