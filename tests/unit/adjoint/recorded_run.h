// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/run/forward_run.h>

#include <optional>

namespace retroforge
{
  /// A small block under a tilted die, with a soft penalty: nodes arrive one by one, and no term is small.
  inline Parameters tilted_block()
  {
    Parameters p;
    p.billet.size         = Vec3({30, 30, 30});
    p.billet.element_size = 14;
    p.dies                = {DieParameters("lower"), DieParameters("upper")};
    p.dies[0].facing      = Vec3({0, 0, 1});
    p.dies[1].point       = Vec3({15, -15, 30});
    p.dies[1].facing      = Vec3({-0.029809, 0.081900, -0.996195});
    p.dies[1].velocity    = Vec3({0, 0, -100});
    for (DieParameters &die : p.dies)
      die.friction = 0.4;
    p.material.law.e0       = 0.3;
    p.press.stroke          = 3.;
    p.press.increments      = 4;
    p.contact.approach      = 2.;
    p.contact.penetration   = 1e-2;
    p.contact.slip_fraction = 0.1;
    p.newton.tolerance      = 1e-13;
    p.adjoint.tolerance     = 1e-13;
    p.linear_solver.method  = LinearSolverParameters::Method::direct;
    return p;
  }

  enum class Meshes
  {
    one, ///< for all of a run
    anew ///< as the parameters have it
  };

  inline Parameters resolved(Parameters all, const Meshes meshes)
  {
    if (meshes == Meshes::one)
      all.remeshing.when = RemesherParameters::When::never;
    all.resolve_defaults({all.billet.size[2], all.billet.size[2]});
    return all;
  }

  /// The problem of a box billet between dies.
  inline ForgingProblem problem_between(const Parameters            &parameters,
                                        std::vector<Die>             dies,
                                        Objectives                   given,
                                        const std::optional<Scheme> &scheme)
  {
    const double   height = parameters.billet.size[2];
    ForgingProblem problem(parameters,
                           make_billet(parameters.billet, MPI_COMM_WORLD),
                           std::move(dies),
                           parameters.process({height, height}),
                           std::move(given));
    if (scheme)
      problem.model.step.scheme = *scheme;
    return problem;
  }

  inline Timings &timings_of_runs()
  {
    static Timings timings;
    return timings;
  }

  /// A scene forged once, its increments kept, to be differentiated and replayed.
  struct RecordedRun : ForwardRun
  {
    /// @param given  the objectives; those of the parameters when it is empty
    /// @param scheme  in time; that of the parameters when there is none
    /// @param meshes  whether the mesh may be made anew
    RecordedRun(const Parameters            &all,
                std::vector<Die>             dies,
                Objectives                   given  = {},
                const std::optional<Scheme> &scheme = {},
                const Meshes                 meshes = Meshes::one)
        : RecordedRun(problem_between(resolved(all, meshes), std::move(dies), std::move(given), scheme))
    {
    }

    /// @param problem  whose parameters have their defaults
    explicit RecordedRun(ForgingProblem problem)
        : RecordedRun(Parameters(problem.parameters), std::move(problem))
    {
    }

    explicit RecordedRun(const Parameters &all) : RecordedRun(all, {all.dies[0].die(), all.dies[1].die()}) {}

    /// Of the first objective.
    AdjointResult adjoint() const { return sweep(each(objectives())).gradients[0]; }

    /// Of the first objective.
    double derivative(const Process<Dual> &along, const NodalVectors<Dual> &X) const
    {
      return tangent(along, X)[0].dx(0);
    }

    double replayed_energy(const Process<double> &at, const NodalVectors<double> &X) const
    {
      return replay(at, X).energy.total();
    }

    const Parameters             parameters;
    const Scene                 &scene;
    std::vector<IncrementRecord> records;

  private:
    RecordedRun(Parameters all, ForgingProblem &&problem)
        : ForwardRun(std::move(problem), Keep::increments, timings_of_runs())
        , parameters(std::move(all))
        , scene(first_epoch().scene)
    {
      forge();
      values(); // objectives of the end choose their features
      const auto record = recording().access();
      for (unsigned int i = 0; i < state().increments; ++i)
        records.push_back(record(i));
    }
  };

  /// Positions at the starts of the increments of a run on one mesh, and at its end.
  inline std::vector<NodalVectors<double>> positions_of(const RecordedRun &run)
  {
    std::vector<NodalVectors<double>> X = {run.X_0()};
    for (const IncrementRecord &record : run.records)
      X.push_back(run.first_epoch().increment.mechanics.positions_after(run.process(), X.back(), record));
    return X;
  }
} // namespace retroforge
