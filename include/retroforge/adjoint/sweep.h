// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/time/forging.h>

namespace retroforge
{
  /// dPhi/dX_0 and dPhi/d(process).
  struct AdjointResult
  {
    NodalVectors<double> X_0;
    ProcessBar           process;
    unsigned int         linear_solves = 0;
  };

  /// The backward sweep over all recorded increments of a run for Phi = energy: one linear solve per stage,
  /// J^T at each remeshing. Two meshes are in memory while one is left for the other.
  /// @param first  the leg in which the run began
  /// @param end    where it ended; earlier positions follow from the recorded velocities
  AdjointResult adjoint_sweep(const ForgingModel         &model,
                              const std::shared_ptr<Leg> &first,
                              const Process<double>      &process,
                              const ForgingState         &end,
                              const Forging::Source      &source,
                              Timings                    &timings);

  /// The direct method: derivative of the energy over n recorded increments along one direction of (X_0,
  /// process), by the same kernels run forward on dual numbers.
  Energy<Dual> tangent_sweep(const ForgingModel    &model,
                             std::shared_ptr<Leg>   leg,
                             const Process<Dual>   &process,
                             NodalVectors<Dual>     X_0,
                             unsigned int           n,
                             const Forging::Source &source,
                             Timings               &timings);
} // namespace retroforge
