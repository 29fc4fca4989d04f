// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/version.h>
#include <retroforge/design/mesh_anew.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/output/blas.h>
#include <retroforge/run/run_summary.h>

namespace retroforge
{
  namespace
  {
    /// How often the objective's value stands in the whole part; NaN where it says nothing of that.
    double copies(const Case &at, const NamedObjective &objective, const WholePart &whole)
    {
      if (objective.extent == Extent::none)
        return Summary::unknown;
      return objective.extent == Extent::part
               ? whole.copies
               : whole_part(at.billet, at.process.dies[objective.die].velocity).force;
    }

    void summarise_restarts(const std::vector<Stretch> &stretches, Summary &summary)
    {
      for (std::size_t s = 1; s < stretches.size(); ++s)
      {
        const RecordedInput &input = stretches[s].input;
        summary.restarts.push_back({input.first + 1, input.stroke, {}});
        for (const ChangedSetting &setting :
             changed_numerics(stretches[s - 1].input.parameters, input.parameters))
          summary.restarts.back().changed[setting.path] = {setting.before, setting.now};
      }
    }
  } // namespace

  double shape_volume(const Case &at)
  {
    if (!has_measures(at.parameters.billet))
      return Summary::unknown;
    const TetMesh &made = at.first.mesh;
    return shape_volume(at.first.shapes.measured(at.first.at)) / volume(made.cells, made.X) *
           volume(made.cells, at.X_0);
  }

  void summarise_run(const Case &at, const ForgingState &forged, Summary &summary)
  {
    summary.command               = at.command.command;
    summary.version               = version;
    summary.commit                = commit;
    summary.blas                  = blas_in_use();
    summary.ranks                 = dealii::Utilities::MPI::n_mpi_processes(at.comm);
    summary.n_nodes               = at.billet.n_nodes();
    summary.n_cells               = at.billet.n_cells();
    summary.newton_iterations     = forged.newton;
    summary.krylov_iterations     = forged.krylov;
    summary.linear_solves_forward = forged.linear_solves;
    summary.remeshings            = forged.remeshed.size();
    summary.increments            = forged.increments;
    summary.cuts                  = forged.cuts;
    summary.volume_initial        = volume(at.billet.cells, at.X_0);
    summary.volume_final          = volume(forged.leg->scene.mesh.cells, forged.X);
    summary.volume_repaired       = forged.repaired;
    summarise_restarts(at.stretches, summary);
  }

  void summarise_objectives(const Case                &at,
                            const ObjectiveTrace      &trace,
                            const ForgingState        &forged,
                            const std::vector<double> &values,
                            Summary                   &summary)
  {
    const auto beside = trace.beside(forged);
    for (std::size_t o = 0; o < at.objectives.size(); ++o)
      summary.objectives.push_back({at.objectives[o].name,
                                    values[o],
                                    at.objectives[o].unit(),
                                    beside[o].parts,
                                    beside[o].details,
                                    copies(at, at.objectives[o], summary.whole) * values[o]});
    if (at.parameters.objectives.gradients == "combined")
      summary.objectives.push_back(
        {at.combinations[0].name, at.combine(values)[0], at.combinations[0].unit, {}, {}});
  }

  void summarise_gradients(const Case &at, const std::vector<Judged> &judged, Summary &summary)
  {
    for (std::size_t j = 0; j < at.mu.size() && !judged.empty(); ++j)
    {
      const DesignParameter &parameter = at.design.parameters()[j];
      summary.parameters.push_back({parameter.name, at.mu[j], parameter.unit, {}, parameter.scale});
      for (const Judged &objective : judged)
        summary.parameters.back().gradient[objective.name] = objective.gradient[j];
    }
  }
} // namespace retroforge
