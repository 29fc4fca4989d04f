// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/time/increment.h>

namespace retroforge
{
  struct PressParameters
  {
    std::string  leading_die;
    double       stroke          = 10.;
    unsigned int increments      = 0;
    std::string  scheme          = "midpoint";
    double       smallest_volume = 0.2;
    double       largest_move    = 0.5;
    unsigned int max_cuts        = 8;

    void add_parameters(dealii::ParameterHandler &prm);
  };

  /// What is known at the end of an increment.
  struct IncrementEvent
  {
    unsigned int                index; ///< from 1
    const IncrementRecord      &record;
    const IncrementReport      &report;
    const NodalVectors<double> &X_before;
    const NodalVectors<double> &X;
    const Field<double>        &W;
    double                      time;
    double                      energy; ///< so far [mJ]
  };

  /// Outcome of a run.
  struct ForgingResult
  {
    NodalVectors<double> X;
    Energy<double>       energy;
    unsigned int         increments = 0, cuts = 0, newton = 0, krylov = 0;
  };

  /// The time loop: increments of equal stroke, halved while an element would invert or a node would cross
  /// too much of an edge. In a replay the recorded increments are obeyed instead.
  class Forging
  {
  public:
    using Watch  = std::function<void(const IncrementEvent &)>;
    using Source = std::function<const IncrementRecord &(unsigned int)>;

    Forging(const Scene &scene, const PressParameters &press, Increment &increment);

    /// Decides everything anew.
    ForgingResult run(const Process<double> &process, const NodalVectors<double> &X_0, const Watch &watch);

    /// Obeys the decisions of n recorded increments, and starts each solve from the recorded one.
    ForgingResult replay(const Process<double>      &process,
                         const NodalVectors<double> &X_0,
                         unsigned int                n,
                         const Source               &source);

  private:
    bool acceptable(const NodalVectors<double> &X, const NodalVectors<double> &X_next) const;

    const Scene           &scene_;
    const PressParameters &press_;
    Increment             &increment_;
  };
} // namespace retroforge
