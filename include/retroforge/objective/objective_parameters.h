// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/objective_type.h>

namespace retroforge
{
  /// What a parameter file says about one objective: the section `Objective NAME`.
  struct ObjectiveParameters
  {
    std::string           name;
    Choice<ObjectiveType> type;
    double                weight = 1.;

    /// A name that is one of the types' is of that type unless said otherwise.
    explicit ObjectiveParameters(const std::string &name);

    static std::vector<std::string> types();

    void add_parameters(dealii::ParameterHandler &prm);

    /// @throws Error  for a die, target or patch that is not there, an empty window, exponents out of range
    NamedObjective make(const ObjectiveContext &context) const;

  private:
    std::string section() const { return "Objective " + name; }
  };
} // namespace retroforge
