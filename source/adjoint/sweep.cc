// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/adjoint/sweep.h>
#include <retroforge/discretization/strain_history.h>
#include <retroforge/transfer/cell_transfer.h>

#include <deal.II/base/mpi.h>

namespace retroforge
{
  namespace
  {
    bool is_first(MPI_Comm comm)
    {
      return dealii::Utilities::MPI::this_mpi_process(comm) == 0;
    }

    void add(const double weight, const NodalVectors<double> &from, NodalVectors<double> &to)
    {
      for (std::size_t k = 0; k < to.size(); ++k)
        to[k] += weight * from[k];
    }

    /// Derivatives of objective o, one of the end.
    FinalBar reverse_at_end(const RecordedForging &run, const ForgingState &end, const std::size_t o)
    {
      const FinalObjective &objective = *run.objectives[o].at_end;
      const FinalDecisions &decisions = run.traced.decisions[o];
      const auto            dies      = run.process.at_stroke(end.stroke).dies;
      const auto            view      = final_view(objective, end.leg->scene, end.X, end.strain, dies);
      const auto            integrals = objective.integrals(view, decisions).complete();
      return objective.derivatives(view, decisions, objective.reverse_value(integrals, decisions)).complete();
    }

    bool is_zero(const std::vector<double> &x)
    {
      return std::all_of(x.begin(), x.end(), [](const double entry) { return entry == 0.; });
    }

    /// The costates of the workpiece at the end of the run.
    std::vector<Costate> start_costates(const RecordedForging          &run,
                                        const ForgingState             &end,
                                        const std::vector<Combination> &combinations)
    {
      std::vector<Costate> costates(
        combinations.size(),
        {NodalVectors<double>(end.X.size()), {}, no_process_derivatives(run.model.dies)});
      for (std::size_t o = 0; o < run.objectives.size(); ++o)
      {
        if (!run.objectives[o].at_end)
          continue;
        const FinalBar bar        = reverse_at_end(run, end, o);
        const bool     has_strain = !is_zero(bar.q);
        for (std::size_t j = 0; j < costates.size(); ++j)
        {
          const double weight = combinations[j].weights[o];
          if (weight == 0.)
            continue;
          add(weight, bar.X, costates[j].X);
          if (has_strain)
            costates[j].strain.resize(bar.q.size(), 0.);
          for (std::size_t c = 0; c < costates[j].strain.size(); ++c)
            costates[j].strain[c] += weight * bar.q[c];
          PhysicsBar physics_bar(run.model.dies);
          if (const auto d = run.objectives[o].at_end->target_die(); d != invalid_index)
            add(weight, bar.target, physics_bar.dies[d].vertices);
          for (std::size_t d = 0; d < run.model.dies.size(); ++d)
          {
            physics_bar.dies[d].displacement = weight * bar.dies[d].displacement;
            add(weight, bar.dies[d].vertices, physics_bar.dies[d].vertices);
          }
          if (is_first(run.model.comm)) // those of the process are summed over the ranks
            reverse_at_stroke(run.process, {end.stroke, 0.}, 0., physics_bar, costates[j].process);
        }
      }
      return costates;
    }

    /// What objectives of the path give to increment i.
    StageSource source_of(const RecordedForging               &run,
                          const std::vector<PathRows<double>> &rows_bar,
                          const std::vector<Combination>      &combinations,
                          const unsigned int                   i)
    {
      return [&run, &rows_bar, &combinations, i](
               const std::size_t j, const StageView<double> &view, StageBar &bar) {
        for (std::size_t o = 0; o < run.objectives.size(); ++o)
        {
          const double weight = combinations[j].weights[o] * view.weight;
          if (!run.objectives[o].path || weight == 0.)
            continue;
          std::vector<double> weights = rows_bar[o][i].integrals;
          for (double &w : weights)
            w *= weight;
          run.objectives[o].path->reverse_integrals(view, weights, bar);
          if (is_first(run.model.comm))
            bar.physics.dt += weight * dt_bar(run.traced.rows[o][i], rows_bar[o][i]);
        }
      };
    }

    /// The strain at the start of increment i, where laws depend on it; else empty.
    std::vector<double> strain_at_start(const ForgingState &end, const unsigned int i)
    {
      return end.strains.empty() ? std::vector<double>() : end.strains[i];
    }

    /// From the new mesh back to the old: X' = J X + c, and the strain.
    void reverse_change_mesh(const RemeshRecord        &remesh,
                             const TetMesh             &old_mesh,
                             const std::vector<double> &strain_before,
                             Costate                   &costate)
    {
      costate.X = remesh.transfer.apply_transpose(costate.X);
      if (costate.strain.empty())
        return;
      std::vector<double> strain(old_mesh.n_cells(), 0.);
      reverse_transfer_cells(old_mesh,
                             remesh.X_before,
                             remesh.transfer,
                             remesh.mesh,
                             strain_before,
                             std::move(costate.strain),
                             strain,
                             costate.X);
      costate.strain = std::move(strain);
    }
  } // namespace

  AdjointSweep adjoint_sweep(const RecordedForging          &run,
                             const ForgingState             &end,
                             const std::vector<Combination> &combinations)
  {
    const std::vector<PathRows<double>> &rows = run.traced.rows;
    AssertDimension(end.increments, run.n);
    AssertDimension(rows.size(), run.objectives.size());
    AssertDimension(run.traced.decisions.size(), run.objectives.size());
    Assert(std::all_of(combinations.begin(),
                       combinations.end(),
                       [&](const Combination &of) { return of.weights.size() == run.objectives.size(); }),
           dealii::ExcMessage("a combination has a weight for each objective"));
    std::vector<PathRows<double>> rows_bar(run.objectives.size());
    for (std::size_t o = 0; o < run.objectives.size(); ++o)
      if (run.objectives[o].path)
      {
        AssertDimension(rows[o].size(), end.increments);
        rows_bar[o] = run.objectives[o].path->reverse_value(rows[o]);
      }
    std::vector<Costate>      costates = start_costates(run, end, combinations);
    NodalVectors<double>      X        = end.X;
    std::vector<unsigned int> remeshed = end.remeshed;
    std::shared_ptr<Leg>      leg      = end.leg;
    AdjointSweep              sweep;
    leg->increment.forget();
    for (unsigned int i = end.increments; i-- > 0;)
    {
      const IncrementRecord &record = run.source(i);
      const unsigned int     before = leg->system.n_solves;
      X                             = leg->increment.retreat(run.process, X, record);
      leg->increment.reverse(
        run.process, X, strain_at_start(end, i), record, source_of(run, rows_bar, combinations, i), costates);
      sweep.linear_solves += leg->system.n_solves - before;
      if (record.remesh)
      {
        const auto remesh = record.remesh;
        remeshed.pop_back();
        leg = remeshed.empty()
                ? run.first
                : std::make_shared<Leg>(run.source(remeshed.back()).remesh->mesh, run.model, run.timings);
        leg->increment.forget();
        X = remesh->X_before;
        for (Costate &costate : costates)
          reverse_change_mesh(*remesh, leg->scene.mesh, end.strains_before[remeshed.size()], costate);
      }
    }
    for (Costate &costate : costates)
    {
      sum_over_ranks(costate.process, run.model.comm);
      sweep.of.push_back({std::move(costate.X), std::move(costate.process)});
    }
    return sweep;
  }

  std::vector<Dual>
  tangent_sweep(const RecordedForging &run, const Process<Dual> &process, NodalVectors<Dual> X)
  {
    AssertDimension(X.size(), run.first->scene.mesh.n_nodes());
    AssertDimension(process.dies.size(), run.model.dies.size());
    std::shared_ptr<Leg>        leg = run.first;
    std::vector<PathRows<Dual>> rows(run.objectives.size());
    std::vector<Dual>           strain(leg->scene.mesh.n_cells(), Dual(0.));
    double                      end = 0.;
    for (unsigned int i = 0; i < run.n; ++i)
    {
      const IncrementRecord &record = run.source(i);
      if (record.remesh)
      {
        const RemeshRecord &remesh = *record.remesh;
        strain                     = transfer_cells(leg->scene.mesh, X, remesh.transfer, remesh.mesh, strain);
        X                          = remesh.transfer.positions(X);
        leg                        = std::make_shared<Leg>(record.remesh->mesh, run.model, run.timings);
      }
      end = record.stroke + record.step;
      for (auto &of_objective : rows)
        of_objective.push_back(row_of(record, process));
      X =
        leg->increment.tangent(process, X, strain, record, [&](const StageView<Dual> &view, const Dual &dt) {
          for (std::size_t o = 0; o < run.objectives.size(); ++o)
            if (run.objectives[o].path)
              add_integrals(*run.objectives[o].path, view, rows[o].back());
          strain = accumulate_strain(
            leg->scene.discretization, view.stage.X, view.W, Dual(view.weight * dt), strain);
        });
      complete_entries(leg->scene.discretization.cells(), strain.data(), 1);
    }
    const auto        dies = process.at_stroke(end).dies;
    std::vector<Dual> values;
    for (std::size_t o = 0; o < run.objectives.size(); ++o)
      if (run.objectives[o].path)
        values.push_back(run.objectives[o].path->value(rows[o]));
      else
      {
        const FinalObjective &objective = *run.objectives[o].at_end;
        const auto            view      = final_view(objective, leg->scene, X, strain, dies);
        const FinalDecisions &decisions = run.traced.decisions[o];
        values.push_back(objective.value(objective.integrals(view, decisions).complete(), decisions));
      }
    return values;
  }
} // namespace retroforge
