// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/adjoint/sweep.h>
#include <retroforge/case/case.h>
#include <retroforge/record/recording.h>

namespace retroforge
{
  /// A forging of a case at another design, on its first mesh: everything that a run decides is decided anew,
  /// dies of other shape included. Kept in memory, it can be swept back.
  class ForwardRun
  {
  public:
    enum class Keep
    {
      nothing,
      increments ///< for sweep()
    };

    /// @param forging_case       its case, which must live as long
    /// @param process  dies of another shape with their vertices there, as Design::process() gives them
    /// @param X_0      initial positions of the nodes of the case's billet
    ForwardRun(const Case &forging_case, Process<double> process, NodalVectors<double> X_0, Keep keep);
    ForwardRun(const ForwardRun &) = delete; // its members refer to each other

    /// Checks the scene before the first increment.  @throws Error  where nothing can come of it
    void check() const;

    /// Solves all increments.
    /// @param watch  is told of each increment  @throws Error  where the forging cannot go on
    void forge(const Forging::Watch &watch = {});

    /// Returns the values of the objectives, after forge().  @throws Error  for one that is not finite
    std::vector<double> values();

    /// Returns them with what is reported beside each, after values(). Collective.
    std::vector<ObjectiveTrace::Evaluation> evaluations() const { return trace_.evaluate(state_); }

    /// Goes back through the increments, which must be kept, after values().
    AdjointSweep sweep(const std::vector<Combination> &combinations);

    /// Writes the increments that are kept into a folder from which a run goes on; on one rank.
    /// @param parameters  of the case at this design   @throws Error  if it cannot be written
    void write_record(const std::string &directory, const std::string &parameters) const;

    const ForgingState         &end() const { return state_; }
    const Process<double>      &process() const { return process_; }
    const NodalVectors<double> &X_0() const { return X_0_; }
    const std::vector<Die>     &dies() const { return model_.dies; }

  private:
    const Case                &case_;
    const NodalVectors<double> X_0_;
    ForgingModel               model_;
    Process<double>            process_; ///< its dies' vertices are those of the model's dies
    Timings                    timings_;
    const Objectives           objectives_;
    ObjectiveTrace             trace_;
    std::shared_ptr<Leg>       first_leg_;
    ForgingState               state_;
    const Keep                 keep_;
    Recording                  recording_;
  };
} // namespace retroforge
