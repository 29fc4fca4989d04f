// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/enum_setting.h>
#include <retroforge/core/error.h>
#include <retroforge/core/text.h>
#include <retroforge/geometry/stl_file.h>
#include <retroforge/objective/objective_settings.h>

namespace retroforge
{
  namespace
  {
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
  } // namespace

  void add_sharpness(dealii::ParameterHandler &prm, double &sharpness)
  {
    prm.add_parameter("sharpness",
                      sharpness,
                      "p of the p-norm (none), k of the log-sum-exp (1/unit of the objective): the larger, "
                      "the nearer to the maximum. Units: see there.",
                      dealii::Patterns::Double(0.));
  }

  void add_temperature_smoothing(dealii::ParameterHandler &prm, double &smoothing)
  {
    prm.add_parameter(
      "temperature smoothing",
      smoothing,
      "Difference of temperatures over which an extreme is smoothed: it is missed by about 1.5 "
      "times as much. Units: K.",
      dealii::Patterns::Double(1e-300));
  }

  void DieSetting::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter(
      "die",
      name,
      "Of an effort, contact pressure, wear or temperature; empty: the leading die. Units: none.");
  }

  unsigned int DieSetting::find(const std::string &where, const ObjectiveContext &context) const
  {
    return name.empty() ? context.leading_die : find_die(where, context, name);
  }

  unsigned int DieSetting::find_moving(const std::string &where, const ObjectiveContext &context) const
  {
    const unsigned int d = find(where, context);
    if (context.states[d].velocity.norm() == 0.)
      throw Error(where + "/die",
                  "'" + name + "' stands still",
                  "an effort is the power over the speed of a die that moves, or its force along its path",
                  "leave it empty for the leading die");
    return d;
  }

  void WindowSettings::add_parameters(dealii::ParameterHandler &prm)
  {
    using Over = PathWindow::Over;
    add_enum<Over>(prm,
                   "window over",
                   over,
                   {{"stroke", Over::stroke}, {"time", Over::time}},
                   "The part of the run over which an objective is taken is one of stroke or of time. "
                   "Units: none.");
    prm.add_parameter("window begin", begin, "Units: mm or s.", dealii::Patterns::Double(0.));
    prm.add_parameter(
      "window end", end, "0 for the end of the run. Units: mm or s.", dealii::Patterns::Double(0.));
  }

  PathWindow WindowSettings::make(const std::string &where, const ObjectiveContext &context) const
  {
    PathWindow window;
    window.over  = over;
    window.begin = begin;
    if (end > 0.)
      window.end = end;
    window.check(where);
    const double last = window.over == PathWindow::Over::time ? context.time : context.stroke;
    if (window.begin >= last)
      throw Error(where + "/window begin",
                  "is " + as_text(window.begin) + ", but the run ends at " + as_text(last),
                  "some of the run must lie in the window",
                  "let it begin earlier, or lengthen Press/stroke");
    return window;
  }

  void MaximumSettings::add_parameters(dealii::ParameterHandler &prm)
  {
    using Kind = SmoothMaximum::Kind;
    add_enum<Kind>(prm,
                   "smooth maximum",
                   kind,
                   {{"p-norm", Kind::p_norm}, {"log-sum-exp", Kind::log_sum_exp}},
                   "The differentiable stand-in for a maximum. Units: none.");
    add_sharpness(prm, sharpness);
  }

  SmoothMaximum MaximumSettings::make(const std::string &where) const
  {
    SmoothMaximum smooth;
    smooth.kind      = kind;
    smooth.sharpness = sharpness;
    smooth.check(where + "/sharpness");
    return smooth;
  }

  void BoxSettings::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter(
      "region from",
      from,
      "Lower corner of the box in which folds and stresses are looked for, or shapes compared; equal "
      "corners: everywhere, or what lies behind the mouth of a die for its unfilled volume. "
      "Units: mm.");
    prm.add_parameter("region to", to, "Upper corner. Units: mm.");
  }

  std::optional<Box> BoxSettings::make(const std::string &where) const
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

  void RegionSettings::add_parameters(dealii::ParameterHandler &prm)
  {
    box.add_parameters(prm);
    prm.add_parameter("region edge",
                      edge,
                      "Width over which what lies outside of the box ceases to count, of an objective of the "
                      "path. Units: mm.",
                      dealii::Patterns::Double(1e-300));
  }

  std::optional<SmoothRegion> RegionSettings::make(const std::string &where) const
  {
    const auto corners = box.make(where);
    return corners ? std::optional(SmoothRegion{*corners, edge}) : std::nullopt;
  }

  void TargetSettings::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter(
      "target",
      name,
      "`die NAME', whose cavity is to be filled, or the STL file of the shape desired, found as "
      "that of a die is, its normals outwards. Units: none.");
    region.add_parameters(prm);
  }

  void TargetSettings::check_names(const std::string &where, const ObjectiveContext &context) const
  {
    if (is_die())
    {
      find_die(where, context, name.substr(4));
      return;
    }
    const std::string file = name.substr(name.rfind('/') + 1);
    for (const Die &die : context.dies)
      if (die.name == file)
        throw Error(where + "/target",
                    "is '" + file + "', which is read as the name of an STL file",
                    "a die of the scene is named as `die NAME'",
                    "set `die " + file + "'");
  }

  TargetSurface TargetSettings::make(const std::string &where, const ObjectiveContext &context) const
  {
    if (name.empty())
      throw Error(where + "/target",
                  "is empty",
                  "a shape is compared with a target",
                  "set `die NAME', or an STL file of the shape desired");
    const std::optional<Box> box = region.make(where);
    return is_die() ? cavity(where, context, box) : shape(where, box);
  }

  TargetSurface TargetSettings::cavity(const std::string        &where,
                                       const ObjectiveContext   &context,
                                       const std::optional<Box> &box) const
  {
    const unsigned int d = find_die(where, context, name.substr(4));
    if (!context.dies[d].surface())
      throw Error(where + "/target",
                  "die '" + context.dies[d].name + "' is a plane",
                  "a plane has no cavity to fill",
                  "name a die of a shape other than plane");
    return TargetSurface(std::make_shared<TriangleSurface>(*context.dies[d].surface()), d, box);
  }

  TargetSurface TargetSettings::shape(const std::string &where, const std::optional<Box> &box) const
  {
    auto surface = std::make_shared<TriangleSurface>(read_stl(name, where + "/target"));
    if (!surface->is_closed() && !box)
      throw Error(where + "/target",
                  "'" + name + "' is not watertight",
                  "there is no inside of an open surface",
                  "close it, or give a region that ends at its rim, as at planes of symmetry");
    return TargetSurface(std::move(surface), invalid_index, box);
  }

  void TargetType::check_names(const std::string &where, const ObjectiveContext &context) const
  {
    target.check_names(where, context);
  }
} // namespace retroforge
