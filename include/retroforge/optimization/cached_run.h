// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/optimization/journal.h>
#include <retroforge/run/forward_run.h>

#include <memory>

namespace retroforge
{
  /// Forgings of a case at one design after another, the last of which stays in memory, where it can be swept
  /// back and looked at. Collective over the ranks of the case.
  class CachedRun
  {
  public:
    /// @param forging_case  must live as long
    explicit CachedRun(const Case &forging_case);

    /// Forges a design.
    /// @param steps  the design whose increments it repeats; null, or this one: it chooses
    /// @return its values, or why there are none
    Evaluation forge(const std::vector<double> &mu, const Evaluation *steps);

    /// Returns the gradient of each objective by itself. @param known  what came of the design, which is
    /// forged again where it is not in memory   @throws Error  where that gives something else, or for a
    /// derivative that is no number
    std::vector<std::vector<double>> gradients(const Evaluation &known, const Evaluation *steps);

    /// Returns the run of a design, to be looked at.
    const ForwardRun &forged(const Evaluation &known, const Evaluation *steps)
    {
      return in_memory(known, steps);
    }

  private:
    ForwardRun &in_memory(const Evaluation &known, const Evaluation *steps);
    std::string described(const std::vector<double> &mu) const;

    const Case                    &case_;
    const std::vector<Combination> each_;
    Timings                        timings_;
    std::unique_ptr<ForwardRun>    run_; ///< null where the last one failed
    std::vector<double>            mu_;  ///< of it
  };
} // namespace retroforge
