// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/adjoint/sweep.h>

namespace retroforge
{
  AdjointResult adjoint_sweep(const ForgingModel         &model,
                              const std::shared_ptr<Leg> &first,
                              const Process<double>      &process,
                              const ForgingState         &end,
                              const Forging::Source      &source,
                              Timings                    &timings)
  {
    AdjointResult             result{NodalVectors<double>(end.X.size()), ProcessBar(model.dies.size())};
    NodalVectors<double>     &G        = result.X_0;
    NodalVectors<double>      X        = end.X;
    std::vector<unsigned int> remeshed = end.remeshed;
    std::shared_ptr<Leg>      leg      = end.leg;
    leg->increment.forget();
    for (unsigned int i = end.increments; i-- > 0;)
    {
      const IncrementRecord &record = source(i);
      const double           dt     = record.step / process.speed();
      const unsigned int     before = leg->system.n_solves;
      for (std::size_t k = 0; k < X.size(); ++k)
        X[k] -= dt * record.solves.back().V[k];
      leg->increment.reverse(process, X, record, 1., G, result.process);
      result.linear_solves += leg->system.n_solves - before;
      if (record.remesh)
      {
        X = record.remesh->X_before;
        G = record.remesh->transfer.apply_transpose(G);
        remeshed.pop_back();
        leg = remeshed.empty() ? first
                               : std::make_shared<Leg>(source(remeshed.back()).remesh->mesh, model, timings);
        leg->increment.forget();
      }
    }
    result.process.sum(model.comm);
    return result;
  }

  Energy<Dual> tangent_sweep(const ForgingModel    &model,
                             std::shared_ptr<Leg>   leg,
                             const Process<Dual>   &process,
                             NodalVectors<Dual>     X,
                             const unsigned int     n,
                             const Forging::Source &source,
                             Timings               &timings)
  {
    Energy<Dual> energy;
    for (unsigned int i = 0; i < n; ++i)
    {
      const IncrementRecord &record = source(i);
      if (record.remesh)
      {
        X   = record.remesh->transfer.positions(X);
        leg = std::make_shared<Leg>(record.remesh->mesh, model, timings);
      }
      X = leg->increment.tangent(process, X, record, energy);
    }
    for (Dual *part : {&energy.deformation, &energy.friction})
    {
      const double value = leg->scene.partition.sum(part->val()), dot = leg->scene.partition.sum(part->dx(0));
      *part                 = Dual(value);
      part->fastAccessDx(0) = dot;
    }
    return energy;
  }
} // namespace retroforge
