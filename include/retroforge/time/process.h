// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/stage.h>

namespace retroforge
{
  /// Everything about the process that a design can change, constant over a run.
  /// `dies[d].displacement` is the die's offset at the start; its position later is offset + velocity * time.
  /// Time follows the stroke: the path of the leading die, at its speed.
  template <typename Number>
  struct Process
  {
    NortonHoff<Number>            law;
    ContactLaw<Number>            contact;
    std::vector<DieState<Number>> dies;
    unsigned int                  leading_die = 0;
    /// Path of the leading die over the stroke, which is that of the nominal design: not 1 where this die
    /// follows a billet whose height has changed.
    Number stretch = Number(1.);

    Number speed() const;

    /// Of the leading die over a part of the stroke [mm]:  stretch stroke / speed  [s].
    Number time(double stroke) const;

    /// Laws and dies when the leading die has gone `stroke` [mm].
    Physics<Number> at_stroke(double stroke) const;
  };

  /// One increment's place: from `stroke` on by `step` [mm], both fixed by decision; the times follow.
  struct StrokeStep
  {
    double stroke, step;
  };

  /// Derivatives of a scalar with respect to a Process.
  struct ProcessBar
  {
    double                        K = 0., m = 0., e0 = 0., rho = 0., v0 = 0., stretch = 0.;
    std::vector<DieState<double>> dies;
    /// In the vertices of each die; empty for planes and dies never touched.
    std::vector<NodalVectors<double>> die_vertices;

    explicit ProcessBar(const std::size_t n_dies) : dies(n_dies, DieState<double>{Vec3(), Vec3(), 0., {}}) {}

    /// Pull-back of at_stroke, dt = time(step) and tau = approach dt.
    void add(const PhysicsBar &bar, const Process<double> &process, const StrokeStep &step, double approach);

    /// Completes the sums of all ranks.
    void sum(MPI_Comm comm);
  };
} // namespace retroforge
