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
  };

  /// The backward sweep over n recorded increments for Phi = energy: one linear solve per stage.
  /// @param X_N  final positions; earlier ones follow from the recorded velocities
  AdjointResult adjoint_sweep(const Scene                &scene,
                              Increment                  &increment,
                              const Process<double>      &process,
                              const NodalVectors<double> &X_N,
                              unsigned int                n,
                              const Forging::Source      &source);

  /// The direct method: derivative of the energy along one direction of (X_0, process), by the same kernels
  /// run forward on dual numbers.
  Energy<Dual> tangent_sweep(Increment             &increment,
                             const Scene           &scene,
                             const Process<Dual>   &process,
                             NodalVectors<Dual>     X_0,
                             unsigned int           n,
                             const Forging::Source &source);
} // namespace retroforge
