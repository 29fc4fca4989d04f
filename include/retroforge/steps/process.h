// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/stage.h>

namespace retroforge
{
  /// One increment's place: from `stroke` on by `step` [mm], both fixed by decision; the times follow.
  struct StrokeStep
  {
    double stroke, step;
  };

  /// Everything about the process that a design can change, constant over a run. Derivatives of a scalar in
  /// it are another such aggregate. `dies[d].displacement` is the die's offset at the start; its position
  /// later is offset + velocity * time. Time follows the stroke: the path of the leading die, at its speed.
  template <typename Number>
  struct Process
  {
    Material<Number>              material;
    ContactLaw<Number>            contact;
    std::vector<DieState<Number>> dies;
    unsigned int                  leading_die = 0;
    /// Path of the leading die over the stroke, which is that of the nominal design: not 1 where this die
    /// follows a billet whose height has changed.
    Number stretch = Number(1.);

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[material, contact, dies, leading_die, stretch] = self;
      return std::tie(material, contact, dies, leading_die, stretch);
    }

    Number speed() const;

    /// Of the leading die over a part of the stroke [mm]:  stretch stroke / speed  [s].
    Number time(double stroke) const;

    /// Laws and dies when the leading die has gone `stroke` [mm].
    Physics<Number> at_stroke(double stroke) const;
  };

  /// Pull-back of at_stroke, dt = time(step) and tau = approach dt: adds to process_bar.
  void reverse_at_stroke(const Process<double> &process,
                         const StrokeStep      &step,
                         double                 approach,
                         const PhysicsBar      &bar,
                         Process<double>       &process_bar);

  /// Zero derivatives in a process of these dies.
  Process<double> no_process_derivatives(const std::vector<Die> &dies);

  /// Completes the sums of all ranks.
  void sum_over_ranks(Process<double> &process_bar, MPI_Comm comm);
} // namespace retroforge
