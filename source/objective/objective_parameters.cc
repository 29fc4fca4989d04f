// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
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
} // namespace retroforge
