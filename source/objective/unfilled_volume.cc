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

  UnfilledVolume::Grid UnfilledVolume::make_grid(const FinalView<double> &view) const
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
    const Vec3 size = box.second - box.first;
    Grid       grid{{}, box.first, {}, layer_ * longest() / n_samples_};
    for (unsigned int i = 0; i < 3; ++i)
    {
      grid.n[i]       = std::max(1., std::round(n_samples_ * size[i] / longest()));
      grid.spacing[i] = size[i] / grid.n[i];
    }
    return grid;
  }

  Vec3 UnfilledVolume::Grid::sample(const unsigned int g) const
  {
    const unsigned int i[3] = {g % n[0], g / n[0] % n[1], g / n[0] / n[1]};
    Vec3               x;
    for (unsigned int d = 0; d < 3; ++d)
      x[d] = origin[d] + (i[d] + 0.5) * spacing[d];
    return x;
  }

  namespace
  {
    /// H of a layer of that width.
    template <typename Number>
    Number smooth_step(const Number &x, const double width)
    {
      return 1. - FrictionRamp{width, false}(Number(x + 0.5 * width), false);
    }

    double smooth_step_slope(const double x, const double width)
    {
      return -FrictionRamp{width, false}.derivative(x + 0.5 * width);
    }
  } // namespace

  UnfilledVolume::Decisions UnfilledVolume::compute_decisions(const FinalView<double> &view) const
  {
    const Grid                 grid = make_grid(view);
    Decisions                  decisions{grid.width, WorkpieceSurface(view), {}};
    const TriangleSurface     &workpiece = decisions.workpiece.shape();
    const TriangleSurface      target    = target_.moved(view);
    const ClosestFeature       closest_target(target), closest_workpiece(workpiece);
    const NodalVectors<double> vertices = decisions.workpiece.vertices(view);
    const Sector               sector(view.scene.mesh);
    const auto counts       = [&](const double depth) { return smooth_step(depth, grid.width) > 0.; };
    const auto [begin, end] = share_of_rank(grid.n_samples(), view.scene.discretization.comm());
    for (unsigned int g = begin; g < end; ++g)
    {
      Sample sample;
      sample.x = grid.sample(g);
      sample.volume =
        grid.spacing[0] * grid.spacing[1] * grid.spacing[2] * sector.share(sample.x, grid.spacing);
      if (sample.volume == 0.)
        continue;
      // Behind the rim of an open surface is inside what it bounds.
      sample.target = closest_target(sample.x - target_.displacement(view));
      if (sample.target.found() ? !counts(sign() * target_.distance(view, sample.x, sample.target))
                                : cavity_ == Cavity::in_front)
        continue;
      sample.workpiece = closest_workpiece(sample.x);
      if (sample.workpiece.found() &&
          counts(project_on_feature(workpiece, vertices, sample.workpiece, sample.x, Vec3()).delta))
        decisions.samples.push_back(sample);
    }
    return decisions;
  }

  template <typename Number>
  std::vector<Number> UnfilledVolume::compute_integrals(const FinalView<Number> &view,
                                                        const Decisions         &decisions) const
  {
    const auto &[width, workpiece, samples] = decisions;
    const NodalVectors<Number> vertices     = workpiece.vertices(view);
    Number                     sum(0.);
    for (const Sample &sample : samples)
    {
      Vector3<Number> x;
      for (unsigned int i = 0; i < 3; ++i)
        x[i] = Number(sample.x[i]);
      const Number u =
        project_on_feature(workpiece.shape(), vertices, sample.workpiece, x, Vector3<Number>()).delta;
      const Number c = sample.target.found()
                         ? smooth_step(Number(sign() * target_.distance(view, x, sample.target)), width)
                         : Number(1.);
      sum += sample.volume * c * smooth_step(u, width);
    }
    return {sum};
  }

  void UnfilledVolume::reverse_integrals(const FinalView<double>   &view,
                                         const Decisions           &decisions,
                                         const std::vector<double> &weights,
                                         FinalBar                  &bar) const
  {
    const double          width     = decisions.width;
    const TriangleSurface workpiece = decisions.workpiece.moved(view), target = target_.moved(view);
    NodalVectors<double>  workpiece_bar(workpiece.vertices().size());
    Vec3                  unused; // samples stand still
    for (const Sample &sample : decisions.samples)
    {
      const double weight = weights[0] * sample.volume;
      const double u =
        project_on_feature(workpiece, workpiece.vertices(), sample.workpiece, sample.x, Vec3()).delta;
      double c = 1.;
      if (sample.target.found())
      {
        const double depth = sign() * target_.distance(view, sample.x, sample.target);
        c                  = smooth_step(depth, width);
        if (const double depth_bar = weight * smooth_step(u, width) * smooth_step_slope(depth, width);
            depth_bar != 0.)
          target_.reverse_distance(view, target, sample.x, sample.target, sign() * depth_bar, unused, bar);
      }
      if (const double u_bar = weight * c * smooth_step_slope(u, width); u_bar != 0.)
        reverse_project_on_feature(
          workpiece, sample.workpiece, sample.x, Vec3(), u_bar, Vec3(), unused, unused, &workpiece_bar);
    }
    decisions.workpiece.add(workpiece_bar, bar);
  }

  template std::vector<double> UnfilledVolume::compute_integrals(const FinalView<double> &,
                                                                 const Decisions &) const;
  template std::vector<Dual>   UnfilledVolume::compute_integrals(const FinalView<Dual> &,
                                                               const Decisions &) const;

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
