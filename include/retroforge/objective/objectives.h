// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/final_objective.h>
#include <retroforge/objective/path_objective.h>

#include <memory>

namespace retroforge
{
  /// The rule by which the value of the whole part follows from that of the model that symmetry planes cut
  /// from it.
  enum class SymmetryScaling
  {
    part,  ///< the value adds up over the part
    force, ///< the value is in proportion to the force of a die
    none   ///< the value is the same for the whole, or says nothing of it
  };

  /// An objective under the name that the user gave it: of one of the two kinds.
  struct NamedObjective
  {
    std::string                           name;
    double                                weight  = 1.; ///< in the combination
    SymmetryScaling                       scaling = SymmetryScaling::none;
    unsigned int                          die     = invalid_index; ///< the die of a scaling `force`
    std::unique_ptr<const PathObjective>  path;                    ///< null for an objective of the end
    std::unique_ptr<const FinalObjective> at_end;                  ///< null for an objective of the path
    double                                least = 0.;              ///< no value lies below, in the unit

    std::string unit() const { return path ? path->unit() : at_end->unit(); }
  };

  /// The objectives of a run, in the user's order.
  using Objectives = std::vector<NamedObjective>;

  /// A weighted sum of objectives, differentiated by one costate of the backward sweep.
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

  /// Returns one combination for each objective, of it alone.
  std::vector<Combination> each(const Objectives &objectives);

  /// Returns the sum of all objectives by their weights.
  Combination combined(const Objectives &objectives);
} // namespace retroforge
