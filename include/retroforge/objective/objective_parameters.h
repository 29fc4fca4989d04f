// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/objective_type.h>

namespace retroforge
{
  /// The settings of one objective: the section `Objective NAME`.
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

  /// The section Objectives, and those of each.
  struct ObjectivesParameters
  {
    std::vector<ObjectiveParameters> all      = {ObjectiveParameters("energy")};
    bool                             combined = false; ///< one gradient, of the weighted sum
    unsigned int                     every    = 5;

    void add_parameters(dealii::ParameterHandler &prm);
  };
} // namespace retroforge
