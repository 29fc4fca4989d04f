// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/adjoint/sweep.h>

namespace retroforge
{
  AdjointResult adjoint_sweep(const Scene                &scene,
                              Increment                  &increment,
                              const Process<double>      &process,
                              const NodalVectors<double> &X_N,
                              const unsigned int          n,
                              const Forging::Source      &source)
  {
    AdjointResult        result{NodalVectors<double>(X_N.size()), ProcessBar(scene.dies.size())};
    NodalVectors<double> X = X_N;
    for (unsigned int i = n; i-- > 0;)
    {
      const IncrementRecord &record = source(i);
      const double           dt     = record.step / process.speed();
      for (std::size_t k = 0; k < X.size(); ++k)
        X[k] -= dt * record.solves.back().V[k];
      increment.reverse(process, X, record, 1., result.X_0, result.process);
    }
    result.process.sum(scene.partition.comm);
    return result;
  }

  Energy<Dual> tangent_sweep(Increment             &increment,
                             const Scene           &scene,
                             const Process<Dual>   &process,
                             NodalVectors<Dual>     X,
                             const unsigned int     n,
                             const Forging::Source &source)
  {
    Energy<Dual> energy;
    for (unsigned int i = 0; i < n; ++i)
      X = increment.tangent(process, X, source(i), energy);
    for (Dual *part : {&energy.deformation, &energy.friction})
    {
      const double value = scene.partition.sum(part->val()), dot = scene.partition.sum(part->dx(0));
      *part                 = Dual(value);
      part->fastAccessDx(0) = dot;
    }
    return energy;
  }
} // namespace retroforge
