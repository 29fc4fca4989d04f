// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/adjoint/sweep.h>
#include <retroforge/case/parameters.h>

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
    p.linear_solver.method  = "direct";
    return p;
  }

  enum class Meshes
  {
    one, ///< for all of a run
    anew ///< as the parameters have it
  };

  /// A scene forged once, its increments kept, to be differentiated and replayed.
  struct RecordedRun
  {
    /// @param given  the objectives; those of the parameters when it is empty
    /// @param scheme  in time; that of the parameters when there is none
    /// @param meshes  whether the mesh may be made anew
    RecordedRun(const Parameters            &all,
                std::vector<Die>             dies,
                Objectives                   given  = {},
                const std::optional<Scheme> &scheme = {},
                const Meshes                 meshes = Meshes::one)
        : parameters(settled(all, meshes))
        , process(parameters.process({all.billet.size[2], all.billet.size[2]}))
        , model{parameters.discretization.choice(),
                std::move(dies),
                step_model(parameters, scheme),
                all.newton,
                all.linear_solver,
                MPI_COMM_WORLD}
        , leg(std::make_shared<Leg>(make_billet(all.billet, MPI_COMM_WORLD), model, timings))
        , scene(leg->scene)
        , remesher(parameters.remeshing,
                   parameters.edge_length(scene.mesh),
                   model.dies,
                   scene.mesh.patches,
                   MPI_COMM_WORLD)
        , forging(model, parameters.press, remesher, timings)
        , forged(forging.start(leg, scene.mesh.X))
        , objectives(given.empty() ? all.make_objectives(model.dies, scene.mesh) : std::move(given))
        , trace(objectives, model, process)
    {
      forging.run(process, forged, [&](const IncrementEvent &event) {
        records.push_back(event.record);
        trace.add(event);
      });
    }

    static StepModel step_model(const Parameters &parameters, const std::optional<Scheme> &scheme)
    {
      StepModel model = parameters.step_model();
      model.scheme    = scheme.value_or(model.scheme);
      return model;
    }

    static Parameters settled(Parameters all, const Meshes meshes)
    {
      if (meshes == Meshes::one)
        all.remeshing.when = "never";
      all.resolve_defaults({all.billet.size[2], all.billet.size[2]});
      return all;
    }

    explicit RecordedRun(const Parameters &all) : RecordedRun(all, {all.dies[0].die(), all.dies[1].die()}) {}

    Forging::Source source() const
    {
      return [&](const unsigned int i) -> const IncrementRecord & { return records[i]; };
    }

    RecordedForging recorded()
    {
      return {model, leg, process, source(), static_cast<unsigned int>(records.size()), objectives, timings};
    }

    /// Of the first objective.
    AdjointResult adjoint()
    {
      return adjoint_sweep(recorded(), trace.rows(), forged, each(objectives)).gradients[0];
    }

    double tangent(const Process<Dual> &along, const NodalVectors<Dual> &X)
    {
      return tangent_sweep(recorded(), along, X)[0].dx(0);
    }

    double replayed_energy(const Process<double> &at, const NodalVectors<double> &X) const
    {
      ForgingState state = forging.start(leg, X);
      forging.replay(at, records.size(), source(), state);
      return state.energy.total();
    }

    const Parameters             parameters;
    Timings                      timings;
    Process<double>              process;
    ForgingModel                 model;
    std::shared_ptr<Leg>         leg;
    const Scene                 &scene;
    Remesher                     remesher;
    Forging                      forging;
    std::vector<IncrementRecord> records;
    ForgingState                 forged;
    Objectives                   objectives;
    ObjectiveTrace               trace;
  };
} // namespace retroforge
