// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/enum_setting.h>
#include <retroforge/core/error.h>
#include <retroforge/core/shares.h>
#include <retroforge/core/text.h>
#include <retroforge/mesh/surface_areas.h>
#include <retroforge/objective/filling.h>
#include <retroforge/objective/objective_settings.h>
#include <retroforge/objective/sector.h>

namespace retroforge
{
  FillingObjective::FillingObjective(TargetSurface                   target,
                                     const double                    rounding,
                                     const std::optional<FreeNodes> &free)
      : target_(std::move(target)), rounding_(rounding), free_(free)
  {
    if (!(rounding >= 0.))
      throw Error("Filling",
                  "the rounding of distances is " + as_text(rounding) + " mm",
                  "it must not be negative",
                  "use 0, or a thousandth of an element's edge");
  }

  FillingObjective::Decisions FillingObjective::compute_decisions(const FinalView<double> &view) const
  {
    Decisions decisions;
    decisions.by_workpiece = target_.seen_by_workpiece(view);
    decisions.workpiece    = WorkpieceSurface(view);
    if (free_)
      decisions.near = free_->decide(view);
    const ClosestFeature       closest(decisions.workpiece.shape());
    const NodalVectors<double> vertices = target_.vertices(view);
    const Sector               sector(view.scene.mesh);
    const Vec3                 shift = target_.displacement(view);
    for (const Triangle &triangle : target_.shape().triangles())
      if (sector.contains(shift +
                          (vertices[triangle[0]] + vertices[triangle[1]] + vertices[triangle[2]]) / 3.))
        decisions.target.push_back(triangle);
    const auto [begin, end] = share_of_rank(vertices.size(), view.scene.discretization.comm());
    for (unsigned int l = begin; l < end; ++l)
    {
      const Vec3 x = vertices[l] + shift;
      if (!sector.contains(x) || (target_.region() && !is_inside(*target_.region(), x)))
        continue;
      if (const DieFeature feature = closest(x); feature.found())
        decisions.by_target.push_back({l, feature});
    }
    return decisions;
  }

  template <typename Number>
  Number FillingObjective::rounded(const Number &delta) const
  {
    using std::sqrt;
    if (rounding_ == 0.)
      return value_of(delta) > 0. ? delta : value_of(delta) < 0. ? Number(-delta) : Number(0.);
    return sqrt(Number(delta * delta + rounding_ * rounding_)) - rounding_;
  }

  double FillingObjective::slope(const double delta) const
  {
    if (rounding_ == 0.)
      return delta > 0. ? 1. : delta < 0. ? -1. : 0.;
    return delta / std::sqrt(delta * delta + rounding_ * rounding_);
  }

  template <typename Number>
  std::vector<Number> FillingObjective::compute_integrals(const FinalView<Number> &view,
                                                          const Decisions         &decisions) const
  {
    std::vector<Number> sums(2, Number(0.));
    auto                S = lumped_areas(surface_triangles(view.scene.mesh), view.X);
    if (free_)
    {
      const std::vector<Number> parts = free_->parts(view, decisions.near);
      for (std::size_t k = 0; k < S.size(); ++k)
        S[k] *= parts[k];
    }
    for (const SeenFeature &seen : decisions.by_workpiece)
      sums[0] += rounded(target_.distance(view, view.X[seen.point], seen.feature)) * S[seen.point];
    const auto vertices  = target_.vertices(view);
    const auto workpiece = decisions.workpiece.vertices(view);
    const auto S_target  = lumped_areas(decisions.target, vertices);
    for (const SeenFeature &seen : decisions.by_target)
    {
      const Vector3<Number> x = vertices[seen.point] + target_.displacement(view);
      const auto            projection =
        project_on_feature(decisions.workpiece.shape(), workpiece, seen.feature, x, Vector3<Number>());
      sums[1] += rounded(projection.delta) * S_target[seen.point];
    }
    return sums;
  }

  void FillingObjective::reverse_by_workpiece(const FinalView<double> &view,
                                              const Decisions         &decisions,
                                              const double             weight,
                                              FinalBar                &bar) const
  {
    const auto            triangles = surface_triangles(view.scene.mesh);
    const auto            S         = lumped_areas(triangles, view.X);
    const TriangleSurface moved     = target_.moved(view);
    std::vector<double>   S_bar(S.size(), 0.), parts_bar(S.size(), 0.);
    const auto parts = free_ ? free_->parts(view, decisions.near) : std::vector<double>(S.size(), 1.);
    for (const SeenFeature &seen : decisions.by_workpiece)
    {
      const double delta = target_.distance(view, view.X[seen.point], seen.feature);
      S_bar[seen.point] += weight * rounded(delta) * parts[seen.point];
      parts_bar[seen.point] += weight * rounded(delta) * S[seen.point];
      target_.reverse_distance(view,
                               moved,
                               view.X[seen.point],
                               seen.feature,
                               weight * slope(delta) * S[seen.point] * parts[seen.point],
                               bar.X[seen.point],
                               bar);
    }
    reverse_lumped_areas(triangles, view.X, S_bar, bar.X);
    if (free_)
      free_->reverse(view, decisions.near, parts_bar, bar);
  }

  void FillingObjective::reverse_by_target(const FinalView<double> &view,
                                           const Decisions         &decisions,
                                           const double             weight,
                                           FinalBar                &bar) const
  {
    const auto            vertices  = target_.vertices(view);
    const auto            S         = lumped_areas(decisions.target, vertices);
    const TriangleSurface workpiece = decisions.workpiece.moved(view);
    NodalVectors<double>  workpiece_bar(workpiece.vertices().size()), vertices_bar(vertices.size());
    std::vector<double>   S_bar(S.size(), 0.);
    for (const SeenFeature &seen : decisions.by_target)
    {
      const Vec3   x     = vertices[seen.point] + target_.displacement(view);
      const double delta = project_on_feature(workpiece, workpiece.vertices(), seen.feature, x, Vec3()).delta;
      Vec3         x_bar, unused;
      reverse_project_on_feature(workpiece,
                                 seen.feature,
                                 x,
                                 Vec3(),
                                 weight * slope(delta) * S[seen.point],
                                 Vec3(),
                                 x_bar,
                                 unused,
                                 &workpiece_bar);
      S_bar[seen.point] += weight * rounded(delta);
      vertices_bar[seen.point] += x_bar;
      target_.add_displacement_bar(x_bar, bar);
    }
    decisions.workpiece.add(workpiece_bar, bar);
    if (bar.target.size() != vertices.size())
      return;
    reverse_lumped_areas(decisions.target, vertices, S_bar, vertices_bar);
    for (std::size_t v = 0; v < vertices.size(); ++v)
      bar.target[v] += vertices_bar[v];
  }

  void FillingObjective::reverse_integrals(const FinalView<double>   &view,
                                           const Decisions           &decisions,
                                           const std::vector<double> &weights,
                                           FinalBar                  &bar) const
  {
    reverse_by_workpiece(view, decisions, weights[0], bar);
    reverse_by_target(view, decisions, weights[1], bar);
  }

  template std::vector<double> FillingObjective::compute_integrals(const FinalView<double> &,
                                                                   const Decisions &) const;
  template std::vector<Dual>   FillingObjective::compute_integrals(const FinalView<Dual> &,
                                                                 const Decisions &) const;

  namespace
  {
    struct FillingType : TargetType
    {
      double rounding  = 0.;
      bool   free_only = false;

      void add_parameters(dealii::ParameterHandler &prm) override
      {
        TargetType::add_parameters(prm);
        prm.add_parameter("rounding",
                          rounding,
                          "Of the distance |d| where the surfaces meet, in `filling'. Units: mm.",
                          dealii::Patterns::Double(0.));
        add_enum<bool>(
          prm,
          "nodes",
          free_only,
          {{"all", false}, {"free", true}},
          "Of the workpiece, whose distances a `filling' adds up: of its whole surface, or free: of "
          "what touches no die, gradually over the ramp of friction. Units: none.");
      }

      void make(const std::string      &where,
                const ObjectiveContext &context,
                NamedObjective         &objective) const override
      {
        objective.scaling = SymmetryScaling::part;
        objective.at_end  = std::make_unique<FillingObjective>(
          target.make(where, context),
          rounding,
          free_only ? std::optional<FreeNodes>(context.ramp) : std::nullopt);
      }
    };
  } // namespace

  Choice<ObjectiveType>::Maker filling_type()
  {
    return {"filling", Choice<ObjectiveType>::make<FillingType>};
  }
} // namespace retroforge
