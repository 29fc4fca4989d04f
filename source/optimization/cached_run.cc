// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/optimization/cached_run.h>

#include <deal.II/base/mpi.h>

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

  CachedRun::CachedRun(const Case &forging_case) : case_(forging_case), each_(each(forging_case.objectives))
  {
  }

  Evaluation CachedRun::forge(const std::vector<double> &mu, const Evaluation *steps)
  {
    const auto begin = std::chrono::steady_clock::now();
    Evaluation evaluation;
    evaluation.mu = mu;
    run_.reset(); // two would be in memory
    mu_ = mu;
    try
    {
      case_.design.check_values(mu);
      ForgingProblem problem(case_, case_.design.process(mu), case_.design.positions(mu));
      const bool     repeats = steps != nullptr && steps->mu != mu;
      if (repeats)
        problem.repeat_steps(steps->steps);
      run_ = std::make_unique<ForwardRun>(std::move(problem), ForwardRun::Keep::increments, timings_);
      run_->check();
      run_->forge([&](const IncrementEvent &event) { evaluation.increments = event.state.increments; });
      evaluation.values = of_first_rank(run_->values(), case_.comm);
      if (!repeats && case_.parameters.repeats_steps())
        evaluation.steps = run_->strokes();
    }
    catch (const Error &error)
    {
      run_.reset();
      evaluation.failure = error.what();
    }
    evaluation.seconds = of_first_rank(seconds_since(begin), case_.comm);
    return evaluation;
  }

  std::string CachedRun::described(const std::vector<double> &mu) const
  {
    std::string text;
    for (std::size_t j = 0; j < mu.size(); ++j)
      text += (j == 0 ? " (" : ", ") + case_.design.parameters()[j].name + " = " + as_text(mu[j]);
    return text + ")";
  }

  ForwardRun &CachedRun::in_memory(const Evaluation &known, const Evaluation *steps)
  {
    if (run_ && mu_ == known.mu)
      return *run_;
    const Evaluation again = forge(known.mu, steps);
    if (again.failed())
      throw Error("optimize",
                  "forged a design again" + described(known.mu) + ", which now fails: " + again.failure,
                  "the same design gives the same result on one machine",
                  "begin anew with --overwrite");
    if (known.values != again.values)
      throw Error("optimize",
                  "forged a design again" + described(known.mu) +
                    ", and found other values than the journal has",
                  "a journal belongs to the program, the machine and the number of ranks that wrote it",
                  "go on there, or begin anew with --overwrite");
    return *run_;
  }

  std::vector<std::vector<double>> CachedRun::gradients(const Evaluation &known, const Evaluation *steps)
  {
    const AdjointSweep               sweep = in_memory(known, steps).sweep(each_);
    std::vector<std::vector<double>> gradients;
    for (const AdjointResult &of : sweep.gradients)
    {
      gradients.push_back(of_first_rank(case_.design.pull_back(known.mu, of.X_0, of.process), case_.comm));
      for (const double derivative : gradients.back())
        if (!std::isfinite(derivative))
          throw Error("optimize",
                      "found a derivative that is " + as_text(derivative) + described(known.mu),
                      "results must be finite numbers",
                      "use values of the usual size, of exponents and sharpness in particular");
    }
    return gradients;
  }
} // namespace retroforge
