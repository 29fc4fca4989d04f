// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/optimization/optimization_problem.h>

#include <functional>
#include <optional>

namespace retroforge
{
  /// Start and optimum forged with smaller elements and increments.
  struct Confirmation
  {
    Evaluation   start, best;
    unsigned int n_nodes = 0;
  };

  /// Forges start and optimum with elements and increments Optimisation/confirmation times as large, each on
  /// a mesh made where that of the search was. Collective over all ranks.
  /// @param goes_on  whether forgings are taken from the journal of confirmations that there is
  /// @param tell     prints a line
  /// @return nothing where no such forging is asked for or possible, of which the reason is told
  std::optional<Confirmation> confirm(const OptimizationProblem                      &problem,
                                      const std::vector<double>                      &start,
                                      const std::vector<double>                      &best,
                                      bool                                            goes_on,
                                      const std::function<void(const std::string &)> &tell);
} // namespace retroforge
