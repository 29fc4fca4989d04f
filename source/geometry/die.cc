// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/geometry/die.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    double distance_to_box(const Vec3 &X, const std::pair<Vec3, Vec3> &box)
    {
      Vec3 out;
      for (unsigned int i = 0; i < 3; ++i)
        out[i] = std::max({box.first[i] - X[i], X[i] - box.second[i], 0.});
      return out.norm();
    }
  } // namespace

  Die::Die(std::string name, TriangleSurface surface, const double depth, const DieSurfaceLaw &law)
      : name(std::move(name))
  {
    std::optional<CornerNormals> normals;
    if (law.smooth)
      normals.emplace(surface, law.feature_angle, law.largest_sagitta);
    surface_ =
      std::make_shared<const Surface>(std::move(surface), depth, law.feature_angle, std::move(normals));
  }

  Die Die::moved(NodalVectors<double> vertices) const
  {
    Assert(surface_ && vertices.size() == surface_->shape.vertices().size(),
           dealii::ExcMessage("a die is moved by all vertices of its surface"));
    Die             die     = *this;
    TriangleSurface shape   = surface_->shape;
    auto            normals = surface_->normals;
    shape.move_vertices(std::move(vertices));
    if (normals)
      normals->update(shape);
    die.surface_ = std::make_shared<const Surface>(
      std::move(shape), surface_->depth, surface_->feature_angle, std::move(normals));
    return die;
  }

  DieFeature Die::closest_on_surface(const Vec3 &x, const double within) const
  {
    const DieFeature feature = surface_->closest(x, within);
    return feature.found() && surface_->normals
             ? feature_of_smooth_surface(surface_->shape, *surface_->normals, feature, x)
             : feature;
  }

  DieFeature Die::closest(const Vec3 &X, const Vec3 &displacement, const double reach) const
  {
    if (!surface_)
      return DieFeature();
    const Vec3   x      = X - displacement;
    const double within = std::max(reach, surface_->depth);
    if (distance_to_box(x, surface_->shape.box()) > within)
      return DieFeature::none();
    const DieFeature feature = closest_on_surface(x, within);
    if (!feature.found())
      return feature;
    const double delta = project(x, Vec3(), feature).delta;
    return delta <= reach && -delta <= surface_->depth ? feature : DieFeature::none();
  }

  double Die::signed_distance(const Vec3 &X, const Vec3 &displacement) const
  {
    const DieFeature feature =
      surface_ ? closest_on_surface(X - displacement, std::numeric_limits<double>::max()) : DieFeature();
    return feature.found() ? project(X, displacement, feature).delta
                           : std::numeric_limits<double>::infinity();
  }

  double Die::facet_distance(const Vec3 &X, const Vec3 &displacement) const
  {
    if (!surface_)
      return signed_distance(X, displacement);
    const DieFeature feature = surface_->closest(X - displacement);
    return feature.found()
             ? project_on_feature(surface_->shape, surface_->shape.vertices(), feature, X, displacement).delta
             : std::numeric_limits<double>::infinity();
  }

  double Die::depth_of(const Vec3 &X, const Vec3 &displacement, const double within) const
  {
    const DieFeature feature = surface_ ? closest_on_surface(X - displacement, within) : DieFeature();
    if (!feature.found())
      return 0.;
    const double depth = -project(X, displacement, feature).delta;
    return depth > 0. && depth <= within ? depth : 0.;
  }

  void Die::reverse_project(const Vec3           &X,
                            const Vec3           &displacement,
                            const DieFeature     &feature,
                            const double          delta_bar,
                            const Vec3           &n_bar,
                            Vec3                 &X_bar,
                            Vec3                 &displacement_bar,
                            NodalVectors<double> *vertices_bar) const
  {
    Assert(feature.found(), dealii::ExcMessage("a point is projected on a feature that was found"));
    Assert(vertices_bar == nullptr || (surface_ && vertices_bar->size() == surface_->shape.vertices().size()),
           dealii::ExcMessage("derivatives are in all vertices of a die, or in none"));
    if (surface_ && surface_->normals)
    {
      reverse_project_smoothly(surface_->shape,
                               *surface_->normals,
                               feature,
                               X,
                               displacement,
                               delta_bar,
                               n_bar,
                               X_bar,
                               displacement_bar,
                               vertices_bar);
      return;
    }
    if (surface_)
    {
      reverse_project_on_feature(
        surface_->shape, feature, X, displacement, delta_bar, n_bar, X_bar, displacement_bar, vertices_bar);
      return;
    }
    X_bar -= delta_bar * into_;
    displacement_bar += delta_bar * into_;
  }
} // namespace retroforge
