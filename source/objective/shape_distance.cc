// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/surface_areas.h>
#include <retroforge/objective/objective_settings.h>
#include <retroforge/objective/shape_distance.h>

namespace retroforge
{
  template <typename Number>
  std::vector<Number> ShapeDistance::compute_integrals(const FinalView<Number> &view,
                                                       const Decisions         &seen_features) const
  {
    std::vector<Number> sums(2, Number(0.));
    const auto          S = lumped_areas(surface_triangles(view.scene.mesh), view.X);
    for (const SeenFeature &seen : seen_features)
    {
      const Number delta = target_.distance(view, view.X[seen.point], seen.feature);
      sums[0] += S[seen.point];
      sums[1] += S[seen.point] * delta * delta;
    }
    return sums;
  }

  void ShapeDistance::reverse_integrals(const FinalView<double>   &view,
                                        const Decisions           &seen_features,
                                        const std::vector<double> &weights,
                                        FinalBar                  &bar) const
  {
    const auto            triangles = surface_triangles(view.scene.mesh);
    const auto            S         = lumped_areas(triangles, view.X);
    const TriangleSurface moved     = target_.moved(view);
    std::vector<double>   S_bar(S.size(), 0.);
    for (const SeenFeature &seen : seen_features)
    {
      const double delta = target_.distance(view, view.X[seen.point], seen.feature);
      S_bar[seen.point]  = weights[0] + weights[1] * delta * delta;
      target_.reverse_distance(view,
                               moved,
                               view.X[seen.point],
                               seen.feature,
                               weights[1] * 2. * delta * S[seen.point],
                               bar.X[seen.point],
                               bar);
    }
    reverse_lumped_areas(triangles, view.X, S_bar, bar.X);
  }

  template std::vector<double> ShapeDistance::compute_integrals(const FinalView<double> &,
                                                                const Decisions &) const;
  template std::vector<Dual>   ShapeDistance::compute_integrals(const FinalView<Dual> &,
                                                              const Decisions &) const;

  namespace
  {
    struct ShapeDistanceType : TargetType
    {
      void make(const std::string      &where,
                const ObjectiveContext &context,
                NamedObjective         &objective) const override
      {
        objective.at_end = std::make_unique<ShapeDistance>(target.make(where, context));
      }
    };
  } // namespace

  Choice<ObjectiveType>::Maker shape_distance_type()
  {
    return {"shape distance", Choice<ObjectiveType>::make<ShapeDistanceType>};
  }
} // namespace retroforge
