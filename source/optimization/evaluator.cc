// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/remote_error.h>
#include <retroforge/optimization/evaluator.h>

#include <algorithm>
#include <chrono>

namespace retroforge
{
  namespace
  {
    /// Of a group's work in a wave.
    struct Outcome
    {
      Evaluation  evaluation;
      std::string problem; ///< message of an Error, or empty
      double      seconds = 0.;

      template <typename Archive>
      void serialize(Archive &archive, const unsigned int /*version*/)
      {
        archive &evaluation &problem &seconds;
      }
    };
  } // namespace

  Evaluator::Evaluator(const Scenarios  &scenarios,
                       Journal          &journal,
                       Scatter           scatter,
                       const RankGroups &groups)
      : scenarios_(scenarios), journal_(journal), scatter_(std::move(scatter)), groups_(groups)
  {
    for (std::size_t o = 0; o < scenarios.size(); ++o)
      kept_.push_back(std::make_unique<CachedRun>(scenarios.at(o)));
    const std::size_t n = jobs(scenarios.at(0).mu).size();
    if (groups_.n() > n)
      throw Error("Optimisation/side by side",
                  "is " + std::to_string(groups_.n()) + ", and each design is forged " +
                    (n == 1 ? "once" : std::to_string(n) + " times"),
                  "a group of ranks has one of these forgings at least, or it would only wait",
                  "use " + std::to_string(n) +
                    " at most, and give the groups more ranks; or scatter a parameter, or name operations");
  }

  void Evaluator::renew_main()
  {
    kept_.front() = std::make_unique<CachedRun>(scenarios_.at(0));
  }

  double Evaluator::seconds_each() const
  {
    return n_forged_ == 0 ? 0. : seconds_ / n_forged_;
  }

  Evaluator::Jobs Evaluator::jobs(const std::vector<double> &mu) const
  {
    Jobs all;
    for (std::size_t i = 0; i < scatter_.n_samples(); ++i)
      for (std::size_t o = 0; o < scenarios_.size(); ++o)
        if (Job job{o, scenarios_.values(o, scatter_.sample(mu, i))};
            std::find(all.begin(), all.end(), job) == all.end())
          all.push_back(std::move(job));
    return all;
  }

  const Evaluation *Evaluator::known(const Job &job) const
  {
    return journal_.find(job.mu, scenarios_.name(job.scenario));
  }

  void Evaluator::count(const Job &job, std::vector<AskedJob> &jobs) const
  {
    const AskedJob asked = {journal_.mesh_in(scenarios_.name(job.scenario)), job};
    if (std::find(jobs.begin(), jobs.end(), asked) == jobs.end())
      jobs.push_back(asked);
  }

  std::vector<Evaluator::Jobs> Evaluator::waves(const std::vector<double> &mu) const
  {
    std::vector<Jobs> waves;
    const Jobs        all = jobs(mu);
    for (std::size_t k = 0; k < all.size(); ++k)
    {
      if (k % groups_.n() == 0)
        waves.emplace_back();
      waves.back().push_back(all[k]);
    }
    return waves;
  }

  Evaluation Evaluator::evaluate(const std::vector<double> &mu)
  {
    for (const Jobs &wave : waves(mu))
      if (!forge(wave))
        break; // the rest would not make it better
    return combined(mu);
  }

  Evaluation Evaluator::differentiate(const std::vector<double> &mu)
  {
    evaluate(mu);
    const std::vector<Jobs> all = waves(mu);
    // What was forged last is still in memory.
    std::for_each(all.rbegin(), all.rend(), [&](const Jobs &wave) { sweep(wave); });
    return combined(mu);
  }

  Evaluation Evaluator::combined(const std::vector<double> &mu) const
  {
    std::vector<Evaluation> samples;
    for (std::size_t i = 0; i < scatter_.n_samples(); ++i)
    {
      const std::vector<double> sample = scatter_.sample(mu, i);
      std::vector<Evaluation>   each;
      for (std::size_t o = 0; o < scenarios_.size() && (each.empty() || !each.back().failed()); ++o)
      {
        each.push_back(*known({o, scenarios_.values(o, sample)}));
        if (i > 0 && each.back().mu == scenarios_.values(o, scatter_.sample(mu, 0)))
          each.back().seconds = 0.; // it was forged once
      }
      samples.push_back(scenarios_.joined(sample, each));
      if (samples.back().failed())
        break;
    }
    return scatter_.combined(mu, samples);
  }

  std::vector<bool> Evaluator::which_choose_steps(const Jobs &wave) const
  {
    std::vector<bool> which;
    for (auto job = wave.begin(); job != wave.end(); ++job)
      which.push_back(
        scenarios_.at(job->scenario).parameters.repeats_steps() && steps(job->scenario) == nullptr &&
        std::none_of(wave.begin(), job, [&](const Job &other) { return other.scenario == job->scenario; }));
    return which;
  }

  bool Evaluator::forge(const Jobs &wave)
  {
    const std::vector<bool> first = which_choose_steps(wave);
    const bool              succeed =
      std::find(first.begin(), first.end(), true) == first.end() || forge_some(wave, first);
    return forge_some(wave, std::vector<bool>(wave.size(), true)) && succeed;
  }

  bool Evaluator::forge_some(const Jobs &wave, const std::vector<bool> &which)
  {
    std::vector<bool> is_open;
    bool              fails = false; // one is known to: those behind it are not asked for
    for (std::size_t k = 0; k < wave.size(); ++k)
    {
      const Evaluation *there = known(wave[k]);
      is_open.push_back(which[k] && there == nullptr && !fails);
      fails = fails || (there != nullptr && there->failed());
    }
    std::vector<Evaluation> found = shared_out(
      wave, is_open, [&](const Job &job) { return kept_[job.scenario]->forge(job.mu, steps(job.scenario)); });
    // As one group would have it: what others have forged behind a failure is forgotten.
    for (std::size_t k = 0; k < wave.size(); ++k)
    {
      if (!is_open[k] && known(wave[k]) == nullptr)
        continue; // its turn comes
      count(wave[k], asked_);
      if (is_open[k])
      {
        found[k].operation = scenarios_.name(wave[k].scenario);
        journal_.add(std::move(found[k]));
        ++n_forged_;
      }
      if (known(wave[k])->failed())
        return false;
    }
    return true;
  }

  void Evaluator::sweep(const Jobs &wave)
  {
    std::vector<bool> is_open;
    for (const Job &job : wave)
    {
      count(job, swept_);
      is_open.push_back(known(job)->gradients.empty());
    }
    std::vector<Evaluation> found = shared_out(wave, is_open, [&](const Job &job) {
      Evaluation evaluation;
      evaluation.gradients = kept_[job.scenario]->gradients(*known(job), steps(job.scenario));
      return evaluation;
    });
    for (std::size_t k = wave.size(); k-- > 0;)
      if (is_open[k])
        journal_.add_gradients(journal_.place_of(wave[k].mu, scenarios_.name(wave[k].scenario)),
                               std::move(found[k].gradients));
  }

  std::vector<Evaluation> Evaluator::shared_out(const Jobs                                   &wave,
                                                const std::vector<bool>                      &is_open,
                                                const std::function<Evaluation(const Job &)> &work)
  {
    std::vector<Evaluation> found(wave.size());
    if (std::find(is_open.begin(), is_open.end(), true) == is_open.end())
      return found;
    Outcome    mine;
    const auto begin = std::chrono::steady_clock::now();
    try
    {
      if (groups_.number() < wave.size() && is_open[groups_.number()])
        mine.evaluation = work(wave[groups_.number()]);
    }
    catch (const Error &error)
    {
      mine.problem = error.what();
    }
    mine.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const std::vector<Outcome> all     = groups_.gathered(mine);
    double                     slowest = 0.;
    for (std::size_t k = 0; k < all.size(); ++k)
    {
      if (!all[k].problem.empty())
        throw remote_error(all[k].problem);
      slowest = std::max(slowest, all[k].seconds);
      if (k < wave.size())
        found[k] = all[k].evaluation;
    }
    seconds_ += slowest;
    return found;
  }

  const ForwardRun *Evaluator::forged(const std::vector<double> &mu, const std::size_t scenario)
  {
    const Jobs        all   = jobs(mu);
    const Job         job   = {scenario, middle_sample(mu, scenario)};
    const std::size_t place = std::find(all.begin(), all.end(), job) - all.begin();
    if (place % groups_.n() != groups_.number())
      return nullptr;
    return &kept_[scenario]->forged(*known(job), steps(scenario));
  }
} // namespace retroforge
