// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/optimisation/scatter.h>
#include <retroforge/trial.h>

#include <memory>

namespace retroforge
{
  /// Forgings of a case at one design after another. What the journal has is not forged again; what fails is
  /// an answer, too. The last one forged stays in memory, where it can be swept back and looked at.
  class Trials
  {
  public:
    /// @param at  its case; it and the journal must live as long
    /// @param scatter  over which each design is forged several times
    Trials(const Case &at, Journal &journal, Scatter scatter);

    /// What comes of a design, over its samples: values, or why there are none.
    Evaluation evaluate(const std::vector<double> &mu);

    /// With its gradients, of each objective by itself, of a design whose forging does not fail.
    Evaluation differentiate(const std::vector<double> &mu);

    /// The forging of a design that does not fail, in its middle sample, made again where it is not in
    /// memory.
    const Trial &forged(const std::vector<double> &mu);

    /// The design as it is forged in its middle sample.
    std::vector<double> middle_sample(const std::vector<double> &mu) const
    {
      return scatter_.sample(mu, scatter_.n_samples() / 2);
    }

    /// Forgings that were asked for, each once, and those of them that were forged here.
    unsigned int n_asked() const { return asked_.size(); }
    unsigned int n_forged() const { return n_forged_; }
    unsigned int n_swept() const { return n_swept_; }
    /// Mean time of a forging, sweep included [s].
    double seconds_each() const;

  private:
    Evaluation evaluate_one(const std::vector<double> &mu);
    Evaluation differentiate_one(const std::vector<double> &mu);
    Trial     &forged_one(const std::vector<double> &mu);
    void       forge(const std::vector<double> &mu, Evaluation &evaluation);

    const Case                      &case_;
    Journal                         &journal_;
    const Scatter                    scatter_;
    const std::vector<Combination>   each_;
    std::unique_ptr<Trial>           trial_; ///< the last one forged; null where that failed
    std::vector<double>              forged_mu_;
    std::vector<std::vector<double>> asked_;
    unsigned int                     n_forged_ = 0, n_swept_ = 0;
    double                           seconds_ = 0.;
  };
} // namespace retroforge
