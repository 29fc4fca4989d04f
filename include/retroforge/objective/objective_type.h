// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/choice.h>
#include <retroforge/objective/objectives.h>

namespace retroforge
{
  /// The parts of a scene that objectives refer to.
  struct ObjectiveContext
  {
    const std::vector<Die>              &dies;
    const std::vector<DieState<double>> &states;      ///< at the start
    unsigned int                         leading_die; ///< taken where no die is named
    double                               stroke;      ///< [mm]
    double                               time;        ///< that it takes [s]
    double                               consistency; ///< K, a stress of the size to expect [MPa]
    const TetMesh                       &billet;
    double                               element_size; ///< [mm]
    FrictionRamp ramp;               ///< the friction ramp of contact, by which nodes begin to touch
    bool         warms      = false; ///< whether the workpiece has temperatures
    bool         is_damaged = false; ///< whether its damage is followed
    bool         conducts   = false; ///< whether heat flows to the dies
  };

  /// A type of objective: its settings, and how an objective is made of them. doc/objectives.md says what
  /// each measures.
  class ObjectiveType
  {
  public:
    virtual ~ObjectiveType() = default;

    /// Declares the settings this type reads; types that share some declare them alike.
    virtual void add_parameters(dealii::ParameterHandler &) {}

    /// Looks for the dies and patches that settings name. @param where  their section, for messages
    virtual void check_names([[maybe_unused]] const std::string &where, const ObjectiveContext &) const {}

    /// Fills in `path` or `at_end`, and what makes its value that of the whole part.
    /// @throws Error  for a target that is not there, an empty window, exponents out of range
    virtual void
    make(const std::string &where, const ObjectiveContext &context, NamedObjective &objective) const = 0;
  };

  /// Returns the types there are; a line of its table adds one.
  const Choice<ObjectiveType>::Makers &objective_types();
} // namespace retroforge
