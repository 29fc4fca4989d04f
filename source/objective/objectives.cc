// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/objective/objectives.h>

namespace retroforge
{
  std::vector<Combination> each(const Objectives &objectives)
  {
    std::vector<Combination> combinations;
    for (std::size_t j = 0; j < objectives.size(); ++j)
    {
      combinations.push_back(
        {objectives[j].name, objectives[j].unit(), std::vector<double>(objectives.size(), 0.)});
      combinations.back().weights[j] = 1.;
    }
    return combinations;
  }

  Combination combined(const Objectives &objectives)
  {
    // A sum of one has its unit; others are what the weights make of them.
    Combination sum{"combined", objectives.size() == 1 ? objectives[0].unit() : "", {}};
    for (const NamedObjective &objective : objectives)
      sum.weights.push_back(objective.weight);
    return sum;
  }
} // namespace retroforge
