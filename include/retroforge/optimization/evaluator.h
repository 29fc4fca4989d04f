// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/rank_groups.h>
#include <retroforge/optimization/cached_run.h>
#include <retroforge/optimization/scatter.h>
#include <retroforge/optimization/scenarios.h>

#include <functional>
#include <memory>

namespace retroforge
{
  /// Forgings of one or more scenarios at one design after another. What the journal has is not forged
  /// again; what fails is an answer, too. The forgings of a design, one for each sample and scenario, are
  /// dealt out to groups of ranks: each group forges one of a wave of as many as there are groups, and all of
  /// them get what came of it, so that they take the same decisions and their journals are the same, in the
  /// order of one group.
  ///
  /// Collective over all groups. An Error that one of them meets is thrown by all; another exception
  /// leaves the rest waiting, so it has to end the program.
  class Evaluator
  {
  public:
    /// @param scenarios  on the ranks of this rank's group; they, the groups and the journal must live as
    /// long
    /// @param scatter  over which each design is forged several times
    /// @throws Error  for more groups than forgings of a design
    Evaluator(const Scenarios &scenarios, Journal &journal, Scatter scatter, const RankGroups &groups);

    /// Forges a design in all its samples. @return its values, or why there are none
    Evaluation evaluate(const std::vector<double> &mu);

    /// Returns values and gradients, of each objective by itself, of a design whose forging does not fail.
    Evaluation differentiate(const std::vector<double> &mu);

    /// The forging of a design that does not fail, in its middle sample, made again where it is not in
    /// memory; null in the groups that do not have that sample of the scenario. Not collective over groups.
    const ForwardRun *forged(const std::vector<double> &mu, std::size_t scenario);

    /// The parameters of a scenario as it is forged in the middle sample.
    std::vector<double> middle_sample(const std::vector<double> &mu, const std::size_t scenario) const
    {
      return scenarios_.values(scenario, scatter_.sample(mu, scatter_.n_samples() / 2));
    }

    /// Discards what is kept of the main scenario's mesh, which is another one from here on.
    void renew_main();

    /// Forgings that were asked for, each once on each mesh.
    unsigned int n_asked() const { return asked_.size(); }
    /// Sweeps that were asked for.
    unsigned int n_swept() const { return swept_.size(); }
    /// Returns how many forgings a design takes.
    unsigned int n_forgings(const std::vector<double> &mu) const { return jobs(mu).size(); }
    /// Mean time between the ends of two forgings, sweeps included [s].
    double seconds_each() const;

  private:
    /// A forging that a design asks for.
    struct Job
    {
      std::size_t         scenario;
      std::vector<double> mu; ///< its parameters

      bool operator==(const Job &other) const { return scenario == other.scenario && mu == other.mu; }
    };
    using Jobs     = std::vector<Job>;
    using AskedJob = std::pair<unsigned int, Job>; ///< with the number of its mesh

    const Evaluation *known(const Job &job) const;
    /// Counts a job of the present mesh where it is not among those.
    void count(const Job &job, std::vector<AskedJob> &jobs) const;
    /// In the order in which they are asked for, each once: without the scattered parameter a scenario is
    /// the same in all samples.
    Jobs jobs(const std::vector<double> &mu) const;
    /// Returns the jobs that go on at a time, one for each group.
    std::vector<Jobs> waves(const std::vector<double> &mu) const;
    /// Returns the design whose increments a scenario repeats; null where none is forged yet.
    const Evaluation *steps(std::size_t scenario) const
    {
      return journal_.find_steps(scenarios_.name(scenario));
    }
    /// Which jobs of a wave choose the increments that the others of their scenario repeat.
    std::vector<bool> which_choose_steps(const Jobs &wave) const;
    /// @return whether all of the wave succeeded
    bool forge(const Jobs &wave);
    /// Forges some of a wave, those before the first failure. @return whether all that is known succeeded
    bool forge_some(const Jobs &wave, const std::vector<bool> &which);
    void sweep(const Jobs &wave);
    /// Runs the open jobs of a wave, each by its group, and shares the results.
    std::vector<Evaluation> shared_out(const Jobs                                   &wave,
                                       const std::vector<bool>                      &is_open,
                                       const std::function<Evaluation(const Job &)> &work);
    /// Combines samples that are known, up to the first that fails.
    Evaluation combined(const std::vector<double> &mu) const;

    const Scenarios                        &scenarios_;
    Journal                                &journal_;
    const Scatter                           scatter_;
    const RankGroups                       &groups_;
    std::vector<std::unique_ptr<CachedRun>> kept_; ///< the last one of each scenario in this group
    std::vector<AskedJob>                   asked_, swept_;
    unsigned int                            n_forged_ = 0;
    double                                  seconds_  = 0.;
  };
} // namespace retroforge
