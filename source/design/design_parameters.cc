// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/setting_tags.h>
#include <retroforge/design/design_parameters.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    /// `NAME: VALUE, NAME: VALUE; NAME: VALUE'.
    std::vector<std::multimap<std::string, double>> designs_in(const std::string &text)
    {
      using Values = std::multimap<std::string, double>;
      std::vector<Values> designs;
      try
      {
        for (const std::string &design : dealii::Utilities::split_string_list(text, ';'))
          designs.push_back(dealii::Patterns::Tools::Convert<Values>::to_value(design));
      }
      catch (const dealii::ExceptionBase &)
      {
        throw Error("Design/meshed at",
                    "is '" + legible(text) + "'",
                    "it holds `NAME: VALUE, NAME: VALUE', and semicolons between designs",
                    "correct it, or leave it empty for a mesh at the nominal values");
      }
      return designs;
    }
  } // namespace

  void DesignParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection("Design");
    prm.add_parameter(
      "parameters",
      names,
      "Parameters whose gradient is wanted: material/K, material/m, material/e0, contact/rho, contact/v0, "
      "dies/friction, `die NAME/friction`, `die NAME/shear limit`, `die NAME/zone ZONE/friction`, `die "
      "NAME/speed`, `die NAME/offset`, and "
      "of the billet's "
      "shape: of a box billet/stretch, billet/height, of a cylinder billet/radius, billet/height, of a ring "
      "billet/mu1 to billet/mu4, of a profile `billet/control point I r', `billet/control point I z'; modes "
      "of free forms are `billet/free form I' and `die NAME/free form I'. "
      "The gradient by every node of the billet is always computed, too. Units: none.");
    prm.add_parameter(
      "at",
      at,
      "Design parameters and values they have instead of the nominal ones, `NAME: VALUE, NAME: VALUE'; any "
      "that "
      "the scene offers. The mesh stays that of the nominal design, its nodes moved, and so do increments "
      "and lengths that follow from the nominal billet, but for elements of new meshes, which grow with the "
      "cube root of the "
      "volume; the penalty and the regularisation of slip follow the "
      "material and the speed at which the dies close. Their gradients are computed, too. Units: those of "
      "the "
      "parameters.");
    prm.declare_entry(
      "meshed at",
      "",
      dealii::Patterns::Anything(),
      "Parameters of the billet's shape and values at which the billet is meshed instead of at the nominal "
      "ones, `NAME: VALUE, NAME: VALUE': for designs that the nominal mesh cannot follow. A billet with "
      "measures is meshed with these; one from a file or with a free form is remeshed there, with edges as "
      "long as they were, and by designs in between where several stand one after the other, separated by "
      "semicolons. Values of design parameters mean what they meant. Units: those of the parameters.");
    prm.add_action("meshed at", [this](const std::string &text) { meshed_at = designs_in(text); });
    prm.add_parameter(
      "repeat steps",
      repeat_steps,
      "Other designs than the nominal one, in scan, in optimize and in the differences of check that decide "
      "anew, repeat its increments as `Press/steps' does, so that the objective does not jump where one more "
      "is "
      "made. Units: none.");
    prm.leave_subsection();
    tag(prm, "Design", SettingRole::results);
    for (const char *setting : {"Design/at", "Design/meshed at"})
      tag(prm, setting, SettingRole::scene);
  }

  std::vector<std::string> DesignParameters::all_names() const
  {
    std::vector<std::string> all = names;
    for (const auto &[name, value] : at)
      if (std::find(all.begin(), all.end(), name) == all.end())
        all.push_back(name);
    return all;
  }
} // namespace retroforge
