// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/nearest_name.h>
#include <retroforge/core/number_checks.h>
#include <retroforge/core/setting_tags.h>
#include <retroforge/time/press_parameters.h>

namespace retroforge
{
  void PressParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    std::string              choices;
    std::vector<std::string> described;
    for (const Scheme &known : Scheme::all())
    {
      choices += (choices.empty() ? "" : "|") + known.name;
      described.push_back("`" + known.name + "` " + known.description);
    }
    prm.enter_subsection("Press");
    prm.add_parameter(
      "leading die", leading_die, "Die whose path is the stroke; empty: the first that moves. Units: none.");
    prm.add_parameter(
      "motion",
      motion_type,
      "How the press goes along its stroke: at constant speed, that of the dies; programs that "
      "use the library may add others. Units: none.");
    prm.add_parameter("motion numbers",
                      motion_numbers,
                      "Numbers that the motion has, in its order; a constant speed has none. Units: those of "
                      "the motion.");
    prm.add_parameter("stroke", stroke, "Path of the leading die. Units: mm.", Double(1e-300));
    prm.add_parameter("increments",
                      increments,
                      "Number of equal increments of stroke, before any is cut; 0 for as many as `accuracy' "
                      "needs, short where the metal flows fast. Units: none.",
                      Integer(0));
    prm.add_parameter("accuracy",
                      accuracy,
                      "Relative error of the energy in time to aim at where `increments' is 0: its square "
                      "root is the largest "
                      "strain of an increment, in the mean over where metal flows. Units: none.",
                      Double(1e-6, 0.1));
    prm.add_parameter("steps",
                      steps_file,
                      "Table (.csv) with a column `stroke', at which increments end, as history.csv of a "
                      "run: they are repeated "
                      "instead of being chosen, stretched where they do not end at the stroke. One is halved "
                      "where there is no "
                      "equilibrium, or where it goes more than twice as far as `accuracy' (with increments = "
                      "0), `largest move', "
                      "`largest slip' and `smallest volume' ask. Empty: chosen. Units: none.");
    prm.add_parameter(
      "scheme", scheme, "Time scheme: " + join(described) + ". Units: none.", Selection(choices));
    prm.add_parameter(
      "smallest volume",
      smallest_volume,
      "An increment is halved when an element would keep less than this part of its volume. Units: none.",
      Double(0., 1.));
    prm.add_parameter(
      "largest move",
      largest_move,
      "An increment is halved when two nodes of an edge would move, relative to each other, by more than "
      "this part of its length. Units: none.",
      Double(1e-3));
    prm.add_parameter(
      "largest slip",
      largest_slip,
      "An increment is halved when a node would slip along a curved die by more than this times the edge "
      "length wanted there. Units: none.",
      Double(1e-3));
    prm.add_parameter(
      "max cuts",
      max_cuts,
      "Times an increment may be halved, counted from the whole one, before the run stops. Units: none.",
      Integer(0, 30));
    prm.add_parameter(
      "largest volume change",
      largest_loss,
      "The run stops when the workpiece has lost or won more than this part of its volume. Units: none.",
      Double(0.));
    prm.leave_subsection();
    tag(prm, "Press", SettingRole::numerics);
    tag(prm, "Press/steps", SettingTags::Files::one);
    for (const char *setting : {"leading die", "motion", "motion numbers"})
      tag(prm, std::string("Press/") + setting, SettingRole::scene);
  }

  PressMotion<double> PressParameters::motion() const
  {
    PressMotion<double> motion;
    motion.type    = find_press_motion(motion_type, "Press/motion");
    motion.numbers = motion_numbers;
    check_numbers(motion.numbers,
                  press_motion_type(motion.type).info(),
                  "Press/motion numbers",
                  "the motion '" + motion_type + "'");
    return motion;
  }
} // namespace retroforge
