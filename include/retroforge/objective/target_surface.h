// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/box.h>
#include <retroforge/objective/final_objective.h>

#include <memory>
#include <optional>

namespace retroforge
{
  /// A point and what of a surface is closest to it: a recorded decision.
  struct SeenFeature
  {
    unsigned int point; ///< a node of the workpiece, or a vertex of the target
    DieFeature   feature;
  };

  /// A surface the workpiece should end up on: the shape desired, or a die's working face where the die ends.
  class TargetSurface
  {
  public:
    /// @param die     whose displacement it follows; invalid_index: it stands still
    /// @param region  nodes and vertices outside of it are not compared
    explicit TargetSurface(std::shared_ptr<const TriangleSurface> shape,
                           unsigned int                           die    = invalid_index,
                           const std::optional<Box>              &region = {});

    unsigned int              die() const { return die_; }
    const TriangleSurface    &shape() const { return *shape_; }
    const std::optional<Box> &region() const { return region_; }

    /// Returns the features that this rank's nodes of the workpiece's surface see, ascending by node. Nodes
    /// behind the rim of an open target, or outside the region, see none and are left out.
    std::vector<SeenFeature> seen_by_workpiece(const FinalView<double> &view) const;

    /// Returns the signed distance of a feature from x, > 0 on the side that the normals point to [mm].
    template <typename Number>
    Number distance(const FinalView<Number> &view, const Vector3<Number> &x, const DieFeature &feature) const;

    /// Adds distance_bar times the derivatives of distance to x_bar, and to those in displacement and
    /// vertices. @param moved  the shape at the view's vertices
    void reverse_distance(const FinalView<double> &view,
                          const TriangleSurface   &moved,
                          const Vec3              &x,
                          const DieFeature        &feature,
                          double                   distance_bar,
                          Vec3                    &x_bar,
                          FinalBar                &bar) const;

    /// Returns that of its die.
    template <typename Number>
    Vector3<Number> displacement(const FinalView<Number> &view) const;

    /// Returns the vertices of the view, or its own, without the displacement.
    template <typename Number>
    NodalVectors<Number> vertices(const FinalView<Number> &view) const;

    /// Returns the shape with its vertices there.
    TriangleSurface moved(const FinalView<double> &view) const;

    /// Adds the derivatives in the displacement to those of its die, if it follows one.
    void add_displacement_bar(const Vec3 &displacement_bar, FinalBar &bar) const;

  private:
    std::shared_ptr<const TriangleSurface> shape_;
    unsigned int                           die_;
    std::optional<Box>                     region_;
  };
} // namespace retroforge
