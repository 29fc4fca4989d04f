// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/trials.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace retroforge
{
  namespace
  {
    double seconds_since(const std::chrono::steady_clock::time_point &begin)
    {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    }

    /// Ranks follow the first one's numbers, whatever the order of their sums.
    template <typename T>
    T of_first_rank(const T &x, MPI_Comm comm)
    {
      return dealii::Utilities::MPI::broadcast(comm, x, 0);
    }
  } // namespace

  Trials::Trials(const Case &at, Journal &journal, Scatter scatter)
      : case_(at), journal_(journal), scatter_(std::move(scatter)), each_(each(at.objectives))
  {
  }

  double Trials::seconds_each() const
  {
    return n_forged_ == 0 ? 0. : seconds_ / n_forged_;
  }

  Evaluation Trials::evaluate(const std::vector<double> &mu)
  {
    std::vector<Evaluation> samples;
    for (std::size_t i = 0; i < scatter_.n_samples(); ++i)
    {
      samples.push_back(evaluate_one(scatter_.sample(mu, i)));
      if (samples.back().failed())
        break; // the rest would not make it better
    }
    return scatter_.combined(mu, samples);
  }

  Evaluation Trials::differentiate(const std::vector<double> &mu)
  {
    std::vector<Evaluation> samples;
    // The sample forged last is still in memory.
    for (std::size_t i = scatter_.n_samples(); i-- > 0;)
      samples.insert(samples.begin(), differentiate_one(scatter_.sample(mu, i)));
    return scatter_.combined(mu, samples);
  }

  const Trial &Trials::forged(const std::vector<double> &mu)
  {
    return forged_one(middle_sample(mu));
  }

  Evaluation Trials::evaluate_one(const std::vector<double> &mu)
  {
    if (std::find(asked_.begin(), asked_.end(), mu) == asked_.end())
      asked_.push_back(mu);
    if (const Evaluation *known = journal_.find(mu))
      return *known;
    Evaluation evaluation;
    evaluation.mu = mu;
    forge(mu, evaluation);
    return journal_[journal_.add(std::move(evaluation))];
  }

  void Trials::forge(const std::vector<double> &mu, Evaluation &evaluation)
  {
    const auto begin = std::chrono::steady_clock::now();
    trial_.reset(); // two would be in memory
    forged_mu_ = mu;
    try
    {
      case_.design.check_values(mu);
      trial_ = std::make_unique<Trial>(
        case_, case_.design.process(mu), case_.design.positions(mu), Trial::Keep::increments);
      trial_->check();
      trial_->forge([&](const IncrementEvent &event) { evaluation.increments = event.state.increments; });
      evaluation.values = of_first_rank(trial_->values(), case_.comm);
    }
    catch (const Error &error)
    {
      trial_.reset();
      evaluation.failure = error.what();
    }
    evaluation.seconds = of_first_rank(seconds_since(begin), case_.comm);
    seconds_ += evaluation.seconds;
    ++n_forged_;
  }

  Trial &Trials::forged_one(const std::vector<double> &mu)
  {
    if (!trial_ || forged_mu_ != mu)
    {
      const Evaluation known = evaluate_one(mu);
      Evaluation       again;
      if (!trial_ || forged_mu_ != mu)
        forge(mu, again);
      if (!trial_)
        throw Error("optimize",
                    "forged a design again, which now fails: " + again.failure,
                    "a design gives the same twice on one machine",
                    "begin anew with --overwrite");
      if (known.values != again.values && !again.values.empty())
        throw Error("optimize",
                    "forged a design again, and found other values than the journal has",
                    "a journal belongs to the program, the machine and the number of ranks that wrote it",
                    "go on there, or begin anew with --overwrite");
    }
    return *trial_;
  }

  Evaluation Trials::differentiate_one(const std::vector<double> &mu)
  {
    Evaluation evaluation = evaluate_one(mu);
    if (!evaluation.gradients.empty())
      return evaluation;
    Trial             &trial = forged_one(mu);
    const auto         begin = std::chrono::steady_clock::now();
    const AdjointSweep sweep = trial.sweep(each_);
    for (const AdjointResult &of : sweep.of)
    {
      evaluation.gradients.push_back(
        of_first_rank(case_.design.pull_back(mu, of.X_0, of.process), case_.comm));
      for (const double derivative : evaluation.gradients.back())
        if (!std::isfinite(derivative))
          throw Error("optimize",
                      "found a derivative that is " + as_text(derivative),
                      "results must be finite numbers",
                      "use values of the usual size: exponents and sharpness above all");
    }
    ++n_swept_;
    seconds_ += of_first_rank(seconds_since(begin), case_.comm);
    journal_.add_gradients(journal_.number_of(mu), evaluation.gradients);
    return evaluation;
  }
} // namespace retroforge
