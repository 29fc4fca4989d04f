// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/enum_setting.h>
#include <retroforge/core/setting_tags.h>
#include <retroforge/objective/objective_parameters.h>

namespace retroforge
{
  std::vector<std::string> ObjectiveParameters::types()
  {
    return Choice<ObjectiveType>::names(objective_types());
  }

  namespace
  {
    bool is_type(const std::string &name)
    {
      const auto known = ObjectiveParameters::types();
      return std::find(known.begin(), known.end(), name) != known.end();
    }
  } // namespace

  ObjectiveParameters::ObjectiveParameters(const std::string &name)
      : name(name), type(objective_types(), is_type(name) ? name : "energy")
  {
  }

  void ObjectiveParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection(section());
    type.add_name(prm, "type", "What is measured; doc/objectives.md has a section on each. Units: none.");
    prm.add_parameter("weight", weight, "In the sum of all objectives. Units: 1/(that of the objective).");
    type.add_settings(prm);
    prm.leave_subsection();
    tag(prm, section(), SettingRole::results);
    tag(prm, section() + "/target", SettingTags::Files::one);
    tag(prm, section() + "/type", Choice<ObjectiveType>::read_by(objective_types()));
  }

  NamedObjective ObjectiveParameters::make(const ObjectiveContext &context) const
  {
    for (const auto &any : type.kinds())
      any->check_names(section(), context);
    NamedObjective objective;
    objective.name   = name;
    objective.weight = weight;
    type->make(section(), context, objective);
    return objective;
  }

  void ObjectivesParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection("Objectives");
    prm.declare_entry("names",
                      "energy",
                      dealii::Patterns::Anything(),
                      "Names of the objectives; each has a section `Objective NAME`, and if the name is that "
                      "of a type needs no more. Units: none.");
    add_enum<bool>(
      prm,
      "gradients",
      combined,
      {{"each", false}, {"combined", true}},
      "each: one adjoint per objective, all in one backward sweep; combined: one of their weighted sum. "
      "Units: none.");
    prm.add_parameter(
      "history every",
      every,
      "Evaluate the objectives of the run so far every so many increments; 0 for the end only. Units: none.");
    prm.leave_subsection();
    tag(prm, "Objectives", SettingRole::results);
    for (ObjectiveParameters &objective : all)
      objective.add_parameters(prm);
  }
} // namespace retroforge
