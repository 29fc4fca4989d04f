// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/final_objective.h>
#include <retroforge/objective/path_objective.h>

#include <memory>

namespace retroforge
{
  /// How the value of the whole part follows from that of the model that symmetry planes cut from it: of what
  /// adds up over the part, of the force of a die, and of the rest, which says nothing of the whole or is the
  /// same there.
  enum class SymmetryScaling
  {
    part,
    force,
    none
  };

  /// An objective under the name that the user gave it: of one of the two kinds.
  struct NamedObjective
  {
    std::string                           name;
    double                                weight  = 1.; ///< in the combination
    SymmetryScaling                       scaling = SymmetryScaling::none;
    unsigned int                          die     = invalid_index; ///< of a scaling `force`
    std::unique_ptr<const PathObjective>  path;                    ///< null for one of the end
    std::unique_ptr<const FinalObjective> at_end;                  ///< null for one of the path

    std::string unit() const { return path ? path->unit() : at_end->unit(); }
  };

  /// What a run is judged by, in the user's order.
  using Objectives = std::vector<NamedObjective>;

  /// A weighted sum of objectives: what one costate of the backward sweep belongs to.
  struct Combination
  {
    std::string         name, unit;
    std::vector<double> weights; ///< one per objective

    template <typename Number>
    Number operator()(const std::vector<Number> &values) const
    {
      Number sum(0.);
      for (std::size_t j = 0; j < weights.size(); ++j)
        if (weights[j] != 0.)
          sum += weights[j] * values[j];
      return sum;
    }
  };

  /// Each objective by itself.
  std::vector<Combination> each(const Objectives &objectives);

  /// All by their weights, in one sum.
  Combination combined(const Objectives &objectives);
} // namespace retroforge
