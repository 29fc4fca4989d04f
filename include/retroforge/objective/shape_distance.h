// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/target_surface.h>

/// @file
/// How far the final surface is from the one wanted, as a mean square weighted with the surface.
namespace retroforge
{
  /// sum_k S_k delta_k^2 / sum_k S_k  [mm^2]  over the nodes of the workpiece's surface that see the target,
  /// S_k a third of the areas around them. Smooth where the surfaces meet. Frozen: the closest features.
  class ShapeDistance : public FinalObjectiveOf<ShapeDistance>
  {
  public:
    explicit ShapeDistance(TargetSurface target) : target_(std::move(target)) {}

    std::string  name() const override { return "shape distance"; }
    std::string  unit() const override { return "mm^2"; }
    unsigned int target_die() const override { return target_.die(); }

    void decide(const FinalView<double> &view) override { seen_ = target_.seen_by_workpiece(view); }
    const std::vector<SeenFeature> &decisions() const { return seen_; }

    void reverse_integrals(const FinalView<double>   &view,
                           const std::vector<double> &weights,
                           FinalBar                  &bar) const override;

    template <typename Number>
    std::vector<Number> compute_integrals(const FinalView<Number> &view) const;

    /// 0 when no node sees the target.
    template <typename Number>
    Number combine(const std::vector<Number> &b) const
    {
      return value_of(b[0]) > 0. ? Number(b[1] / b[0]) : Number(0.);
    }

  private:
    TargetSurface            target_;
    std::vector<SeenFeature> seen_;
  };

  /// Distance of named patches from a straight circular cylinder of given axis and the radius that fits best,
  ///   min_R sum_k S_k (r_k - R)^2 / sum_k S_k  [mm^2],
  /// r_k the distance of node k from the axis, S_k a third of the areas of the patches' faces at it: the
  /// variance of the radius. What barrels least has the least of it.
  class CylinderDistance : public FinalObjectiveOf<CylinderDistance>
  {
  public:
    /// @param patches  of the workpiece     @param axis  direction, of any length  @throws Error  for no axis
    /// or no patches
    CylinderDistance(std::vector<std::string> patches, const Vec3 &point, const Vec3 &axis);

    std::string name() const override { return "cylinder distance"; }
    std::string unit() const override { return "mm^2"; }

    /// The radius from which others are measured, to keep digits: Phi does not depend on it.
    void decide(const FinalView<double> &view) override;

    std::map<std::string, double> details(const std::vector<double> &integrals) const override
    {
      return {{"radius [mm]", radius(integrals)}};
    }

    /// The radius that fits best [mm].
    double radius(const std::vector<double> &integrals) const
    {
      return reference_ + integrals[1] / integrals[0];
    }

    void reverse_integrals(const FinalView<double>   &view,
                           const std::vector<double> &weights,
                           FinalBar                  &bar) const override;

    template <typename Number>
    std::vector<Number> compute_integrals(const FinalView<Number> &view) const;

    template <typename Number>
    Number combine(const std::vector<Number> &b) const
    {
      const Number mean = b[1] / b[0];
      return b[2] / b[0] - mean * mean;
    }

  private:
    std::vector<Triangle> triangles(const TetMesh &mesh) const;
    template <typename Number>
    Vector3<Number> from_axis(const Vector3<Number> &x) const;

    std::vector<std::string> patches_;
    Vec3                     point_, axis_;
    double                   reference_ = 0.;
  };
} // namespace retroforge
