// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/shares.h>
#include <retroforge/core/text.h>
#include <retroforge/objective/objective_settings.h>
#include <retroforge/objective/unfilled_volume.h>

#include <algorithm>

namespace retroforge
{
  UnfilledVolume::UnfilledVolume(TargetSurface      target,
                                 const Cavity       cavity,
                                 const unsigned int n_samples,
                                 const double       layer)
      : target_(std::move(target)), cavity_(cavity), n_samples_(n_samples), layer_(layer)
  {
    if (!(layer >= 1.))
      throw Error("Unfilled volume",
                  "the layer is " + as_text(layer) + " spacings thick",
                  "it must be at least 1, or the volume jumps from sample to sample",
                  "use 2");
    if (!(n_samples > 2. * layer))
      throw Error("Unfilled volume",
                  "there are " + std::to_string(n_samples) + " samples along the longest edge",
                  "there must be more than two layers of them",
                  "use 30 to 100");
    if (cavity == Cavity::within && !target_.shape().is_closed() && !target_.region())
      throw Error("Unfilled volume",
                  "the target is open and has no region",
                  "there is no inside of an open surface",
                  "close it, or give a region that ends at the planes of symmetry");
  }

  void UnfilledVolume::lay_grid(const FinalView<double> &view)
  {
    Box        box     = target_.region() ? *target_.region() : bounding_box(target_.vertices(view));
    const auto longest = [&] {
      const Vec3 size = box.second - box.first;
      return std::max({size[0], size[1], size[2]});
    };
    if (!target_.region()) // room for the layer around the target: half of layer * longest() / n_samples
    {
      const double margin = 0.5 * layer_ * longest() / (n_samples_ - layer_);
      for (unsigned int i = 0; i < 3; ++i)
      {
        box.first[i] += target_.displacement(view)[i] - margin;
        box.second[i] += target_.displacement(view)[i] + margin;
      }
    }
    box = Sector(view.scene.mesh).clipped(box);
    for (unsigned int i = 0; i < 3; ++i)
      if (!(box.first[i] < box.second[i]))
        throw Error("Unfilled volume",
                    "the target lies behind a symmetry plane",
                    "only what faces the model is compared with it",
                    "move the target, or turn the plane's normal round");
    origin_         = box.first;
    const Vec3 size = box.second - box.first;
    width_          = layer_ * longest() / n_samples_;
    for (unsigned int i = 0; i < 3; ++i)
    {
      n_[i]       = std::max(1., std::round(n_samples_ * size[i] / longest()));
      spacing_[i] = size[i] / n_[i];
    }
  }

  template <typename Number>
  Number UnfilledVolume::step(const Number &x) const
  {
    return 1. - FrictionRamp{width_, false}(Number(x + 0.5 * width_), false);
  }

  double UnfilledVolume::slope(const double x) const
  {
    return -FrictionRamp{width_, false}.derivative(x + 0.5 * width_);
  }

  void UnfilledVolume::decide(const FinalView<double> &view)
  {
    lay_grid(view);
    workpiece_                        = WorkpieceSurface(view);
    const TriangleSurface      target = target_.moved(view);
    const ClosestFeature       closest_target(target), closest_workpiece(workpiece_.shape());
    const NodalVectors<double> vertices = workpiece_.vertices(view);
    const Sector               sector(view.scene.mesh);
    samples_.clear();
    const auto [begin, end] = share_of_rank(n_[0] * n_[1] * n_[2], view.scene.discretization.comm());
    for (unsigned int g = begin; g < end; ++g)
    {
      const unsigned int i[3] = {g % n_[0], g / n_[0] % n_[1], g / n_[0] / n_[1]};
      Sample             sample;
      for (unsigned int d = 0; d < 3; ++d)
        sample.x[d] = origin_[d] + (i[d] + 0.5) * spacing_[d];
      sample.volume = spacing_[0] * spacing_[1] * spacing_[2] * sector.share(sample.x, spacing_);
      if (sample.volume == 0.)
        continue;
      // Behind the rim of an open surface is inside what it bounds.
      sample.target = closest_target(sample.x - target_.displacement(view));
      if (sample.target.found() ? step(sign() * target_.distance(view, sample.x, sample.target)) == 0.
                                : cavity_ == Cavity::in_front)
        continue;
      sample.workpiece = closest_workpiece(sample.x);
      if (sample.workpiece.found() &&
          step(project_on_feature(workpiece_.shape(), vertices, sample.workpiece, sample.x, Vec3()).delta) >
            0.)
        samples_.push_back(sample);
    }
  }

  template <typename Number>
  std::vector<Number> UnfilledVolume::compute_integrals(const FinalView<Number> &view) const
  {
    const NodalVectors<Number> vertices = workpiece_.vertices(view);
    Number                     sum(0.);
    for (const Sample &sample : samples_)
    {
      Vector3<Number> x;
      for (unsigned int i = 0; i < 3; ++i)
        x[i] = Number(sample.x[i]);
      const Number u =
        project_on_feature(workpiece_.shape(), vertices, sample.workpiece, x, Vector3<Number>()).delta;
      const Number c =
        sample.target.found() ? step(Number(sign() * target_.distance(view, x, sample.target))) : Number(1.);
      sum += sample.volume * c * step(u);
    }
    return {sum};
  }

  void UnfilledVolume::reverse_integrals(const FinalView<double>   &view,
                                         const std::vector<double> &weights,
                                         FinalBar                  &bar) const
  {
    const TriangleSurface workpiece = workpiece_.moved(view), target = target_.moved(view);
    NodalVectors<double>  workpiece_bar(workpiece.vertices().size());
    Vec3                  unused; // samples stand still
    for (const Sample &sample : samples_)
    {
      const double weight = weights[0] * sample.volume;
      const double u =
        project_on_feature(workpiece, workpiece.vertices(), sample.workpiece, sample.x, Vec3()).delta;
      double c = 1.;
      if (sample.target.found())
      {
        const double depth = sign() * target_.distance(view, sample.x, sample.target);
        c                  = step(depth);
        if (const double depth_bar = weight * step(u) * slope(depth); depth_bar != 0.)
          target_.reverse_distance(view, target, sample.x, sample.target, sign() * depth_bar, unused, bar);
      }
      if (const double u_bar = weight * c * slope(u); u_bar != 0.)
        reverse_project_on_feature(
          workpiece, sample.workpiece, sample.x, Vec3(), u_bar, Vec3(), unused, unused, &workpiece_bar);
    }
    workpiece_.add(workpiece_bar, bar);
  }

  template std::vector<double> UnfilledVolume::compute_integrals(const FinalView<double> &) const;
  template std::vector<Dual>   UnfilledVolume::compute_integrals(const FinalView<Dual> &) const;

  namespace
  {
    struct UnfilledVolumeType : TargetType
    {
      unsigned int samples = 40;
      double       layer   = 2.;

      void add_parameters(dealii::ParameterHandler &prm) override
      {
        TargetType::add_parameters(prm);
        prm.add_parameter("samples",
                          samples,
                          "Of an unfilled volume, along the longest edge. Units: none.",
                          dealii::Patterns::Integer(3, 1000));
        prm.add_parameter("layer",
                          layer,
                          "Over which its samples fade out. Units: spacings of the samples.",
                          dealii::Patterns::Double(1.));
      }

      void make(const std::string      &where,
                const ObjectiveContext &context,
                NamedObjective         &objective) const override
      {
        objective.scaling = SymmetryScaling::part;
        objective.at_end  = std::make_unique<UnfilledVolume>(
          target.make(where, context), target.is_die() ? Cavity::in_front : Cavity::within, samples, layer);
      }
    };
  } // namespace

  Choice<ObjectiveType>::Maker unfilled_volume_type()
  {
    return {"unfilled volume", Choice<ObjectiveType>::make<UnfilledVolumeType>};
  }
} // namespace retroforge
