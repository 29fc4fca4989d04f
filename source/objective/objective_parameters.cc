// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/core/text.h>
#include <retroforge/geometry/stl_file.h>
#include <retroforge/objective/contact_pressure.h>
#include <retroforge/objective/energy.h>
#include <retroforge/objective/filling.h>
#include <retroforge/objective/fold.h>
#include <retroforge/objective/objective_parameters.h>
#include <retroforge/objective/shape_distance.h>
#include <retroforge/objective/strain_statistics.h>
#include <retroforge/objective/unfilled_volume.h>
#include <retroforge/objective/volume.h>

namespace retroforge
{
  namespace
  {
    const std::string known_types =
      "energy|mean effort|maximum effort|fold|dimensionless fold|contact pressure|filling|unfilled volume|"
      "shape distance|cylinder distance|mean strain|strain variance|maximum strain|volume";
  }

  std::vector<std::string> ObjectiveParameters::types()
  {
    return dealii::Utilities::split_string_list(known_types, '|');
  }

  ReadBy ObjectiveParameters::read_by_type()
  {
    const std::vector<std::string> effort  = {"die", "by", "window over", "window begin", "window end"};
    const std::vector<std::string> maximum = {"smooth maximum", "sharpness"};
    const std::vector<std::string> fold    = {"exponent", "region from", "region to", "region edge"};
    const std::vector<std::string> target  = {"target", "region from", "region to"};
    const auto and_of = [](std::vector<std::string> a, const std::vector<std::string> &b) {
      a.insert(a.end(), b.begin(), b.end());
      return a;
    };
    return {{"mean effort", effort},
            {"maximum effort", and_of(effort, maximum)},
            {"fold", fold},
            {"dimensionless fold", fold},
            {"contact pressure", {"die", "sharpness"}},
            {"maximum strain", maximum},
            {"filling", and_of(target, {"rounding"})},
            {"unfilled volume", and_of(target, {"samples", "layer"})},
            {"shape distance", target},
            {"cylinder distance", {"patches", "axis point", "axis"}}};
  }

  ObjectiveParameters::ObjectiveParameters(std::string made_name) : name(std::move(made_name))
  {
    const auto known = types();
    if (std::find(known.begin(), known.end(), name) != known.end())
      type = name;
  }

  void ObjectiveParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    prm.enter_subsection(section());
    prm.add_parameter("type",
                      type,
                      "What is measured; doc/objectives.md has a section on each. Units: none.",
                      Selection(known_types));
    prm.add_parameter("weight", weight, "In the sum of all objectives. Units: 1/(that of the objective).");
    prm.add_parameter("die", die, "Of an effort or contact pressure; empty: the leading die. Units: none.");
    prm.add_parameter("by",
                      by,
                      "An effort is the power spent over the die's speed, or the force of the die along its "
                      "velocity. Units: none.",
                      Selection("power|force"));
    prm.add_parameter("window over",
                      window_over,
                      "The part of the run over which an effort is taken is one of stroke or of time. "
                      "Units: none.",
                      Selection("stroke|time"));
    prm.add_parameter("window begin", window_begin, "Units: mm or s.", Double(0.));
    prm.add_parameter("window end", window_end, "0 for the end of the run. Units: mm or s.", Double(0.));
    prm.add_parameter("smooth maximum",
                      maximum,
                      "The differentiable stand-in for a maximum. Units: none.",
                      Selection("p-norm|log-sum-exp"));
    prm.add_parameter("sharpness",
                      sharpness,
                      "p of the p-norm (none), k of the log-sum-exp (1/unit of the objective): the larger, "
                      "the nearer to the maximum. Units: see there.",
                      Double(0.));
    prm.add_parameter("exponent", exponent, "alpha of the fold indicators. Units: none.", Double(0.));
    prm.add_parameter("region from",
                      region_from,
                      "Lower corner of the box in which folds are looked for, or shapes compared; equal "
                      "corners: everywhere. Units: mm.");
    prm.add_parameter("region to", region_to, "Upper corner. Units: mm.");
    prm.add_parameter("region edge",
                      region_edge,
                      "Width over which what folds outside of the box ceases to count. Units: mm.",
                      Double(1e-300));
    prm.add_parameter(
      "target",
      target,
      "`die NAME', whose cavity is to be filled, or the STL file of the shape desired, found as "
      "that of a die is, its normals outwards. Units: none.");
    prm.add_parameter("rounding",
                      rounding,
                      "Of the distance |d| where the surfaces meet, in `filling'. Units: mm.",
                      Double(0.));
    prm.add_parameter(
      "samples", samples, "Of an unfilled volume, along the longest edge. Units: none.", Integer(3, 1000));
    prm.add_parameter(
      "layer", layer, "Over which its samples fade out. Units: spacings of the samples.", Double(1.));
    prm.add_parameter(
      "patches",
      patches,
      "Of the billet, compared with a cylinder: `side' of a cylinder, `side outer' of a ring or profile. "
      "Units: none.");
    prm.add_parameter("axis point", axis_point, "Of the cylinder. Units: mm.");
    prm.add_parameter("axis", axis, "Direction of the cylinder. Units: none.");
    prm.leave_subsection();
  }

  unsigned int ObjectiveParameters::find_die(const ObjectiveContext &context,
                                             const std::string      &die_name) const
  {
    std::string known;
    for (unsigned int d = 0; d < context.dies.size(); ++d)
    {
      if (context.dies[d].name == die_name)
        return d;
      known += (d > 0 ? ", " : "") + context.dies[d].name;
    }
    throw Error(section(),
                "there is no die '" + die_name + "'",
                "an objective refers to a die of the scene",
                "name one of: " + known);
  }

  unsigned int ObjectiveParameters::moving_die(const ObjectiveContext &context) const
  {
    const unsigned int d = die.empty() ? context.leading_die : find_die(context, die);
    if (context.states[d].velocity.norm() == 0.)
      throw Error(section() + "/die",
                  "'" + die + "' stands still",
                  "an effort is the power over the speed of a die that moves, or its force along its path",
                  "leave it empty for the leading die");
    return d;
  }

  Effort ObjectiveParameters::effort(const ObjectiveContext &context) const
  {
    return Effort(moving_die(context), by == "force" ? Effort::By::force : Effort::By::power);
  }

  PathWindow ObjectiveParameters::window(const ObjectiveContext &context) const
  {
    PathWindow window;
    window.over  = window_over == "time" ? PathWindow::Over::time : PathWindow::Over::stroke;
    window.begin = window_begin;
    if (window_end > 0.)
      window.end = window_end;
    window.check(section());
    const double speed = context.states[context.leading_die].velocity.norm();
    const double end   = window.over == PathWindow::Over::time ? context.stroke / speed : context.stroke;
    if (window.begin >= end)
      throw Error(section() + "/window begin",
                  "is " + as_text(window.begin) + ", but the run ends at " + as_text(end),
                  "some of the run must lie in the window",
                  "let it begin earlier, or lengthen Press/stroke");
    return window;
  }

  SmoothMaximum ObjectiveParameters::smooth_maximum() const
  {
    SmoothMaximum smooth;
    smooth.kind      = maximum == "p-norm" ? SmoothMaximum::Kind::p_norm : SmoothMaximum::Kind::log_sum_exp;
    smooth.sharpness = sharpness;
    smooth.check(section() + "/sharpness");
    return smooth;
  }

  std::optional<Box> ObjectiveParameters::box() const
  {
    if ((region_to - region_from).norm() == 0.)
      return {};
    for (unsigned int i = 0; i < 3; ++i)
      if (!(region_from[i] < region_to[i]))
        throw Error(section() + "/region from",
                    "is not below `region to' in each coordinate",
                    "the two are the lower and the upper corner of a box",
                    "give the lower coordinates first");
    return Box(region_from, region_to);
  }

  std::optional<SmoothRegion> ObjectiveParameters::region() const
  {
    const auto corners = box();
    if (!corners)
      return {};
    return SmoothRegion{*corners, region_edge};
  }

  bool ObjectiveParameters::target_is_die() const
  {
    return target.rfind("die ", 0) == 0;
  }

  TargetSurface ObjectiveParameters::target_surface(const ObjectiveContext &context) const
  {
    if (target.empty())
      throw Error(section() + "/target",
                  "is empty",
                  "a shape is compared with a target",
                  "set `die NAME', or an STL file of the shape desired");
    if (!target_is_die())
    {
      auto shape = std::make_shared<TriangleSurface>(read_stl(target));
      if (!shape->is_closed() && !box())
        throw Error(section() + "/target",
                    "'" + target + "' is not watertight",
                    "there is no inside of an open surface",
                    "close it, or give a region that ends at its rim, as at planes of symmetry");
      return TargetSurface(std::move(shape), invalid_index, box());
    }
    const unsigned int d = find_die(context, target.substr(4));
    if (!context.dies[d].surface())
      throw Error(section() + "/target",
                  "die '" + context.dies[d].name + "' is a plane",
                  "a plane has no cavity to fill",
                  "name a die of shape stl, tripod or bell");
    return TargetSurface(std::make_shared<TriangleSurface>(*context.dies[d].surface()), d, box());
  }

  void ObjectiveParameters::check_names(const ObjectiveContext &context) const
  {
    if (!die.empty())
      find_die(context, die);
    if (target_is_die())
      find_die(context, target.substr(4));
    std::vector<std::string> known;
    for (const Patch &patch : context.billet.patches)
      if (!patch.symmetry)
        known.push_back(patch.name);
    for (const std::string &patch : patches)
      if (std::find(known.begin(), known.end(), patch) == known.end())
        throw Error(section() + "/patches",
                    "there is no patch '" + patch + "'",
                    "the patches of this billet are: " + join(known),
                    "name some of these");
    if (type == "cylinder distance" && patches.empty())
      throw Error(section() + "/patches",
                  "names no patch",
                  "a part of the surface must be compared",
                  "name the free side; the patches of this billet are: " + join(known));
  }

  std::unique_ptr<PathObjective> ObjectiveParameters::make_path(const ObjectiveContext &context) const
  {
    if (type == "energy")
      return std::make_unique<EnergyObjective>();
    if (type == "mean effort")
      return std::make_unique<MeanEffort>(effort(context), window(context));
    if (type == "maximum effort")
      return std::make_unique<MaximumEffort>(effort(context), window(context), smooth_maximum());
    if (type == "fold")
      return std::make_unique<FoldObjective>(exponent, region());
    if (type == "dimensionless fold")
      return std::make_unique<DimensionlessFold>(exponent, region());
    if (type == "contact pressure")
      return std::make_unique<ContactPressure>(
        die.empty() ? context.leading_die : find_die(context, die), sharpness, context.consistency);
    return nullptr;
  }

  std::unique_ptr<FinalObjective> ObjectiveParameters::make_at_end(const ObjectiveContext &context) const
  {
    if (type == "filling")
      return std::make_unique<FillingObjective>(target_surface(context), rounding);
    if (type == "unfilled volume")
      return std::make_unique<UnfilledVolume>(
        target_surface(context), target_is_die() ? Cavity::in_front : Cavity::within, samples, layer);
    if (type == "shape distance")
      return std::make_unique<ShapeDistance>(target_surface(context));
    if (type == "cylinder distance")
      return std::make_unique<CylinderDistance>(patches, axis_point, axis);
    if (type == "mean strain")
      return std::make_unique<StrainObjective>(StrainStatistic::mean);
    if (type == "strain variance")
      return std::make_unique<StrainObjective>(StrainStatistic::variance);
    if (type == "maximum strain")
      return std::make_unique<StrainObjective>(StrainStatistic::maximum, smooth_maximum());
    return std::make_unique<VolumeObjective>();
  }

  Extent ObjectiveParameters::extent() const
  {
    if (type == "mean effort" || type == "maximum effort")
      return Extent::force;
    for (const char *name : {"energy", "fold", "filling", "unfilled volume", "volume"})
      if (type == name)
        return Extent::part;
    return Extent::none;
  }

  NamedObjective ObjectiveParameters::make(const ObjectiveContext &context) const
  {
    check_names(context);
    NamedObjective objective;
    objective.name   = name;
    objective.weight = weight;
    objective.extent = extent();
    if (objective.extent == Extent::force)
      objective.die = moving_die(context);
    objective.path = make_path(context);
    if (!objective.path)
      objective.at_end = make_at_end(context);
    return objective;
  }
} // namespace retroforge
