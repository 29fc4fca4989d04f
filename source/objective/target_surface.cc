// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/objective/target_surface.h>

namespace retroforge
{
  TargetSurface::TargetSurface(std::shared_ptr<const TriangleSurface> shape,
                               const unsigned int                     die,
                               const std::optional<Box>              &region)
      : shape_(std::move(shape)), die_(die), region_(region)
  {
  }

  template <typename Number>
  Vector3<Number> TargetSurface::displacement(const FinalView<Number> &view) const
  {
    return die_ == invalid_index ? Vector3<Number>() : view.dies[die_].displacement;
  }

  template <typename Number>
  NodalVectors<Number> TargetSurface::vertices(const FinalView<Number> &view) const
  {
    if (view.target)
      return *view.target;
    NodalVectors<Number> vertices(shape_->vertices().size());
    for (std::size_t v = 0; v < vertices.size(); ++v)
      for (unsigned int i = 0; i < 3; ++i)
        vertices[v][i] = Number(shape_->vertices()[v][i]);
    return vertices;
  }

  TriangleSurface TargetSurface::moved(const FinalView<double> &view) const
  {
    TriangleSurface surface = *shape_;
    if (view.target)
      surface.move_vertices(*view.target);
    return surface;
  }

  void TargetSurface::add_displacement_bar(const Vec3 &displacement_bar, FinalBar &bar) const
  {
    if (die_ != invalid_index)
      bar.dies[die_].displacement += displacement_bar;
  }

  std::vector<SeenFeature> TargetSurface::seen_by_workpiece(const FinalView<double> &view) const
  {
    const TriangleSurface    surface = moved(view);
    const ClosestFeature     closest(surface);
    const Vec3               shift = displacement(view);
    std::vector<SeenFeature> seen;
    for (NodeIndex k = 0; k < view.X.size(); ++k)
      if (view.scene.discretization.owns(k) && view.scene.topology.is_on_surface(k) &&
          (!region_ || is_inside(*region_, view.X[k])))
        if (const DieFeature feature = closest(view.X[k] - shift); feature.found())
          seen.push_back({k, feature});
    return seen;
  }

  template <typename Number>
  Number TargetSurface::distance(const FinalView<Number> &view,
                                 const Vector3<Number>   &x,
                                 const DieFeature        &feature) const
  {
    const auto projected = [&](const auto &vertices) {
      return project_on_feature(*shape_, vertices, feature, x, displacement(view)).delta;
    };
    return view.target ? projected(*view.target) : projected(shape_->vertices());
  }

  void TargetSurface::reverse_distance(const FinalView<double> &view,
                                       const TriangleSurface   &moved,
                                       const Vec3              &x,
                                       const DieFeature        &feature,
                                       const double             distance_bar,
                                       Vec3                    &x_bar,
                                       FinalBar                &bar) const
  {
    Vec3       displacement_bar;
    const bool by_vertices = bar.target.size() == moved.vertices().size();
    reverse_project_on_feature(moved,
                               feature,
                               x,
                               displacement(view),
                               distance_bar,
                               Vec3(),
                               x_bar,
                               displacement_bar,
                               by_vertices ? &bar.target : nullptr);
    add_displacement_bar(displacement_bar, bar);
  }

#define RETROFORGE_INSTANTIATE(Number)                                                        \
  template Vector3<Number>      TargetSurface::displacement(const FinalView<Number> &) const; \
  template NodalVectors<Number> TargetSurface::vertices(const FinalView<Number> &) const;     \
  template Number               TargetSurface::distance(                                      \
    const FinalView<Number> &, const Vector3<Number> &, const DieFeature &) const;
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
