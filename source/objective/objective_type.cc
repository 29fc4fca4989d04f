// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/core/text.h>
#include <retroforge/geometry/stl_file.h>
#include <retroforge/objective/contact_pressure.h>
#include <retroforge/objective/effort.h>
#include <retroforge/objective/energy.h>
#include <retroforge/objective/filling.h>
#include <retroforge/objective/fold.h>
#include <retroforge/objective/objective_type.h>
#include <retroforge/objective/radius.h>
#include <retroforge/objective/shape_distance.h>
#include <retroforge/objective/smooth_maximum.h>
#include <retroforge/objective/smooth_region.h>
#include <retroforge/objective/strain_statistics.h>
#include <retroforge/objective/target_surface.h>
#include <retroforge/objective/unfilled_volume.h>
#include <retroforge/objective/volume.h>

namespace retroforge
{
  namespace
  {
    using namespace dealii::Patterns;
    using dealii::ParameterHandler;

    unsigned int
    find_die(const std::string &where, const ObjectiveContext &context, const std::string &die_name)
    {
      std::string known;
      for (unsigned int d = 0; d < context.dies.size(); ++d)
      {
        if (context.dies[d].name == die_name)
          return d;
        known += (d > 0 ? ", " : "") + context.dies[d].name;
      }
      throw Error(where,
                  "there is no die '" + die_name + "'",
                  "an objective refers to a die of the scene",
                  "name one of: " + known);
    }

    // Settings that several types read.

    struct DieSetting
    {
      std::string name;

      void add_parameters(ParameterHandler &prm)
      {
        prm.add_parameter(
          "die", name, "Of an effort or contact pressure; empty: the leading die. Units: none.");
      }

      unsigned int find(const std::string &where, const ObjectiveContext &context) const
      {
        return name.empty() ? context.leading_die : find_die(where, context, name);
      }

      unsigned int find_moving(const std::string &where, const ObjectiveContext &context) const
      {
        const unsigned int d = find(where, context);
        if (context.states[d].velocity.norm() == 0.)
          throw Error(
            where + "/die",
            "'" + name + "' stands still",
            "an effort is the power over the speed of a die that moves, or its force along its path",
            "leave it empty for the leading die");
        return d;
      }
    };

    struct WindowSettings
    {
      std::string over  = "stroke";
      double      begin = 0., end = 0.;

      void add_parameters(ParameterHandler &prm)
      {
        prm.add_parameter("window over",
                          over,
                          "The part of the run over which an effort is taken is one of stroke or of time. "
                          "Units: none.",
                          Selection("stroke|time"));
        prm.add_parameter("window begin", begin, "Units: mm or s.", Double(0.));
        prm.add_parameter("window end", end, "0 for the end of the run. Units: mm or s.", Double(0.));
      }

      PathWindow make(const std::string &where, const ObjectiveContext &context) const
      {
        PathWindow window;
        window.over  = over == "time" ? PathWindow::Over::time : PathWindow::Over::stroke;
        window.begin = begin;
        if (end > 0.)
          window.end = end;
        window.check(where);
        const double speed = context.states[context.leading_die].velocity.norm();
        const double last  = window.over == PathWindow::Over::time ? context.stroke / speed : context.stroke;
        if (window.begin >= last)
          throw Error(where + "/window begin",
                      "is " + as_text(window.begin) + ", but the run ends at " + as_text(last),
                      "some of the run must lie in the window",
                      "let it begin earlier, or lengthen Press/stroke");
        return window;
      }
    };

    void add_sharpness(ParameterHandler &prm, double &sharpness)
    {
      prm.add_parameter("sharpness",
                        sharpness,
                        "p of the p-norm (none), k of the log-sum-exp (1/unit of the objective): the larger, "
                        "the nearer to the maximum. Units: see there.",
                        Double(0.));
    }

    struct MaximumSettings
    {
      std::string kind      = "p-norm";
      double      sharpness = 20.;

      void add_parameters(ParameterHandler &prm)
      {
        prm.add_parameter("smooth maximum",
                          kind,
                          "The differentiable stand-in for a maximum. Units: none.",
                          Selection("p-norm|log-sum-exp"));
        add_sharpness(prm, sharpness);
      }

      SmoothMaximum make(const std::string &where) const
      {
        SmoothMaximum smooth;
        smooth.kind      = kind == "p-norm" ? SmoothMaximum::Kind::p_norm : SmoothMaximum::Kind::log_sum_exp;
        smooth.sharpness = sharpness;
        smooth.check(where + "/sharpness");
        return smooth;
      }
    };

    struct BoxSettings
    {
      Vec3 from, to;

      void add_parameters(ParameterHandler &prm)
      {
        prm.add_parameter("region from",
                          from,
                          "Lower corner of the box in which folds are looked for, or shapes compared; equal "
                          "corners: everywhere. Units: mm.");
        prm.add_parameter("region to", to, "Upper corner. Units: mm.");
      }

      std::optional<Box> make(const std::string &where) const
      {
        if ((to - from).norm() == 0.)
          return {};
        for (unsigned int i = 0; i < 3; ++i)
          if (!(from[i] < to[i]))
            throw Error(where + "/region from",
                        "is not below `region to' in each coordinate",
                        "the two are the lower and the upper corner of a box",
                        "give the lower coordinates first");
        return Box(from, to);
      }
    };

    /// A shape that the workpiece is compared with.
    struct TargetSettings
    {
      std::string name;
      BoxSettings region;

      void add_parameters(ParameterHandler &prm)
      {
        prm.add_parameter(
          "target",
          name,
          "`die NAME', whose cavity is to be filled, or the STL file of the shape desired, found as "
          "that of a die is, its normals outwards. Units: none.");
        region.add_parameters(prm);
      }

      bool is_die() const { return name.rfind("die ", 0) == 0; }

      void check_names(const std::string &where, const ObjectiveContext &context) const
      {
        if (is_die())
          find_die(where, context, name.substr(4));
      }

      TargetSurface make(const std::string &where, const ObjectiveContext &context) const
      {
        if (name.empty())
          throw Error(where + "/target",
                      "is empty",
                      "a shape is compared with a target",
                      "set `die NAME', or an STL file of the shape desired");
        const std::optional<Box> box = region.make(where);
        return is_die() ? cavity(where, context, box) : shape(where, box);
      }

    private:
      TargetSurface
      cavity(const std::string &where, const ObjectiveContext &context, const std::optional<Box> &box) const
      {
        const unsigned int d = find_die(where, context, name.substr(4));
        if (!context.dies[d].surface())
          throw Error(where + "/target",
                      "die '" + context.dies[d].name + "' is a plane",
                      "a plane has no cavity to fill",
                      "name a die of a shape other than plane");
        return TargetSurface(std::make_shared<TriangleSurface>(*context.dies[d].surface()), d, box);
      }

      TargetSurface shape(const std::string &where, const std::optional<Box> &box) const
      {
        auto surface = std::make_shared<TriangleSurface>(read_stl(name));
        if (!surface->is_closed() && !box)
          throw Error(where + "/target",
                      "'" + name + "' is not watertight",
                      "there is no inside of an open surface",
                      "close it, or give a region that ends at its rim, as at planes of symmetry");
        return TargetSurface(std::move(surface), invalid_index, box);
      }
    };

    // The types.

    struct EnergyType : ObjectiveType
    {
      void make(const std::string &, const ObjectiveContext &, NamedObjective &objective) const override
      {
        objective.extent = Extent::part;
        objective.path   = std::make_unique<EnergyObjective>();
      }
    };

    struct EffortType : ObjectiveType
    {
      DieSetting     die;
      std::string    by = "power";
      WindowSettings window;

      void add_parameters(ParameterHandler &prm) override
      {
        die.add_parameters(prm);
        prm.add_parameter(
          "by",
          by,
          "An effort is the power spent over the die's speed, or the force of the die along its "
          "velocity. Units: none.",
          Selection("power|force"));
        window.add_parameters(prm);
      }

      void check_names(const std::string &where, const ObjectiveContext &context) const override
      {
        die.find(where, context);
      }

      void make(const std::string      &where,
                const ObjectiveContext &context,
                NamedObjective         &objective) const override
      {
        objective.extent = Extent::force;
        objective.die    = die.find_moving(where, context);
        const Effort effort(objective.die, by == "force" ? Effort::By::force : Effort::By::power);
        objective.path = make_path(where, effort, window.make(where, context));
      }

      virtual std::unique_ptr<PathObjective>
      make_path(const std::string &where, const Effort &effort, const PathWindow &path_window) const = 0;
    };

    struct MeanEffortType : EffortType
    {
      std::unique_ptr<PathObjective>
      make_path(const std::string &, const Effort &effort, const PathWindow &path_window) const override
      {
        return std::make_unique<MeanEffort>(effort, path_window);
      }
    };

    struct MaximumEffortType : EffortType
    {
      MaximumSettings maximum;

      void add_parameters(ParameterHandler &prm) override
      {
        EffortType::add_parameters(prm);
        maximum.add_parameters(prm);
      }

      std::unique_ptr<PathObjective>
      make_path(const std::string &where, const Effort &effort, const PathWindow &path_window) const override
      {
        return std::make_unique<MaximumEffort>(effort, path_window, maximum.make(where));
      }
    };

    template <typename Fold>
    struct FoldType : ObjectiveType
    {
      double      exponent = 4.;
      BoxSettings box;
      double      edge = 1.;

      void add_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("exponent", exponent, "alpha of the fold indicators. Units: none.", Double(0.));
        box.add_parameters(prm);
        prm.add_parameter("region edge",
                          edge,
                          "Width over which what folds outside of the box ceases to count. Units: mm.",
                          Double(1e-300));
      }

      void make(const std::string &where, const ObjectiveContext &, NamedObjective &objective) const override
      {
        objective.extent = std::is_same_v<Fold, FoldObjective> ? Extent::part : Extent::none;
        const auto                  corners = box.make(where);
        std::optional<SmoothRegion> region;
        if (corners)
          region = SmoothRegion{*corners, edge};
        objective.path = std::make_unique<Fold>(exponent, region);
      }
    };

    struct ContactPressureType : ObjectiveType
    {
      DieSetting die;
      double     sharpness = 20.;

      void add_parameters(ParameterHandler &prm) override
      {
        die.add_parameters(prm);
        add_sharpness(prm, sharpness);
      }

      void make(const std::string      &where,
                const ObjectiveContext &context,
                NamedObjective         &objective) const override
      {
        objective.path =
          std::make_unique<ContactPressure>(die.find(where, context), sharpness, context.consistency);
      }
    };

    /// A type that compares the workpiece with a target.
    struct TargetType : ObjectiveType
    {
      TargetSettings target;

      void add_parameters(ParameterHandler &prm) override { target.add_parameters(prm); }

      void check_names(const std::string &where, const ObjectiveContext &context) const override
      {
        target.check_names(where, context);
      }
    };

    struct FillingType : TargetType
    {
      double      rounding = 0.;
      std::string nodes    = "all";

      void add_parameters(ParameterHandler &prm) override
      {
        TargetType::add_parameters(prm);
        prm.add_parameter("rounding",
                          rounding,
                          "Of the distance |d| where the surfaces meet, in `filling'. Units: mm.",
                          Double(0.));
        prm.add_parameter(
          "nodes",
          nodes,
          "Of the workpiece, whose distances a `filling' adds up: of its whole surface, or free: of "
          "what touches no die, gradually over the ramp of friction. Units: none.",
          Selection("all|free"));
      }

      void make(const std::string      &where,
                const ObjectiveContext &context,
                NamedObjective         &objective) const override
      {
        objective.extent = Extent::part;
        objective.at_end = std::make_unique<FillingObjective>(
          target.make(where, context),
          rounding,
          nodes == "free" ? std::optional<FreeNodes>(context.ramp) : std::nullopt);
      }
    };

    struct UnfilledVolumeType : TargetType
    {
      unsigned int samples = 40;
      double       layer   = 2.;

      void add_parameters(ParameterHandler &prm) override
      {
        TargetType::add_parameters(prm);
        prm.add_parameter("samples",
                          samples,
                          "Of an unfilled volume, along the longest edge. Units: none.",
                          Integer(3, 1000));
        prm.add_parameter(
          "layer", layer, "Over which its samples fade out. Units: spacings of the samples.", Double(1.));
      }

      void make(const std::string      &where,
                const ObjectiveContext &context,
                NamedObjective         &objective) const override
      {
        objective.extent = Extent::part;
        objective.at_end = std::make_unique<UnfilledVolume>(
          target.make(where, context), target.is_die() ? Cavity::in_front : Cavity::within, samples, layer);
      }
    };

    struct ShapeDistanceType : TargetType
    {
      void make(const std::string      &where,
                const ObjectiveContext &context,
                NamedObjective         &objective) const override
      {
        objective.at_end = std::make_unique<ShapeDistance>(target.make(where, context));
      }
    };

    template <RadiusStatistic statistic>
    struct RadiusType : ObjectiveType
    {
      std::vector<std::string> patches;
      Vec3                     axis_point, axis = Vec3({0., 0., 1.});

      void add_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter(
          "patches",
          patches,
          "Of the billet, whose radius is measured: `side' of a cylinder, `side outer' and `side inner' of a "
          "ring or profile. Units: none.");
        prm.add_parameter("axis point", axis_point, "On the axis that the radius is from. Units: mm.");
        prm.add_parameter("axis", axis, "Its direction. Units: none.");
      }

      static std::vector<std::string> known(const ObjectiveContext &context)
      {
        std::vector<std::string> known;
        for (const Patch &patch : context.billet.patches)
          if (!patch.symmetry)
            known.push_back(patch.name);
        return known;
      }

      void check_names(const std::string &where, const ObjectiveContext &context) const override
      {
        const auto all = known(context);
        for (const std::string &patch : patches)
          if (std::find(all.begin(), all.end(), patch) == all.end())
            throw Error(where + "/patches",
                        "there is no patch '" + patch + "'",
                        "the patches of this billet are: " + join(all),
                        "name some of these");
      }

      void make(const std::string      &where,
                const ObjectiveContext &context,
                NamedObjective         &objective) const override
      {
        if (patches.empty())
          throw Error(where + "/patches",
                      "names no patch",
                      "a part of the surface must be measured",
                      "name the free side; the patches of this billet are: " + join(known(context)));
        objective.at_end = std::make_unique<RadiusObjective>(statistic, patches, axis_point, axis);
      }
    };

    template <StrainStatistic statistic>
    struct StrainType : ObjectiveType
    {
      void make(const std::string &, const ObjectiveContext &, NamedObjective &objective) const override
      {
        objective.at_end = std::make_unique<StrainObjective>(statistic);
      }
    };

    struct MaximumStrainType : ObjectiveType
    {
      MaximumSettings maximum;

      void add_parameters(ParameterHandler &prm) override { maximum.add_parameters(prm); }

      void make(const std::string &where, const ObjectiveContext &, NamedObjective &objective) const override
      {
        objective.at_end = std::make_unique<StrainObjective>(StrainStatistic::maximum, maximum.make(where));
      }
    };

    struct VolumeType : ObjectiveType
    {
      void make(const std::string &, const ObjectiveContext &, NamedObjective &objective) const override
      {
        objective.extent = Extent::part;
        objective.at_end = std::make_unique<VolumeObjective>();
      }
    };
  } // namespace

  const Choice<ObjectiveType>::Makers &objective_types()
  {
    using Types                      = Choice<ObjectiveType>;
    static const Types::Makers types = {
      {"energy", Types::make<EnergyType>},
      {"mean effort", Types::make<MeanEffortType>},
      {"maximum effort", Types::make<MaximumEffortType>},
      {"fold", Types::make<FoldType<FoldObjective>>},
      {"dimensionless fold", Types::make<FoldType<DimensionlessFold>>},
      {"contact pressure", Types::make<ContactPressureType>},
      {"filling", Types::make<FillingType>},
      {"unfilled volume", Types::make<UnfilledVolumeType>},
      {"shape distance", Types::make<ShapeDistanceType>},
      {"cylinder distance", Types::make<RadiusType<RadiusStatistic::variance>>},
      {"mean radius", Types::make<RadiusType<RadiusStatistic::mean>>},
      {"mean strain", Types::make<StrainType<StrainStatistic::mean>>},
      {"strain variance", Types::make<StrainType<StrainStatistic::variance>>},
      {"maximum strain", Types::make<MaximumStrainType>},
      {"volume", Types::make<VolumeType>}};
    return types;
  }
} // namespace retroforge
