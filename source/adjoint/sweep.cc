// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/adjoint/sweep.h>
#include <retroforge/steps/change_of_mesh.h>

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

    /// Derivatives of an objective of the end, complete but for the process.
    FinalBar
    reverse_at_end(const RecordedForging &run, const ForgingState &end, const FinalObjective &objective)
    {
      const MPI_Comm comm = run.model.comm;
      const auto     dies = run.process.at_stroke(end.stroke).dies;
      const auto view = final_view(objective, end.leg->scene, end.workpiece.X, end.workpiece.strain, dies);
      const auto integrals = sum_over_ranks(objective.integrals(view), comm);
      const auto d         = objective.target_die();
      FinalBar   bar(end.leg->scene, d == invalid_index ? 0 : run.model.dies[d].surface()->vertices().size());
      objective.reverse_integrals(view, objective.reverse_value(integrals), bar);
      MPI_Allreduce(MPI_IN_PLACE, bar.X.data()->begin_raw(), 3 * bar.X.size(), MPI_DOUBLE, MPI_SUM, comm);
      bar.q = sum_over_ranks(std::move(bar.q), comm);
      return bar;
    }

    /// The costates of the workpiece at the end of the run.
    std::vector<Costate> start_costates(const RecordedForging          &run,
                                        const ForgingState             &end,
                                        const std::vector<Combination> &combinations)
    {
      std::vector<Costate> costates(combinations.size(),
                                    {zero_costate<3>(end.workpiece.X.size(), end.workpiece.strain.size()),
                                     {no_process_derivatives(run.model.dies), run.model.comm}});
      for (std::size_t o = 0; o < run.objectives.size(); ++o)
      {
        if (!run.objectives[o].at_end)
          continue;
        const FinalBar bar = reverse_at_end(run, end, *run.objectives[o].at_end);
        for (std::size_t j = 0; j < costates.size(); ++j)
        {
          const double weight = combinations[j].weights[o];
          if (weight == 0.)
            continue;
          add(weight, bar.X, costates[j].workpiece.X);
          for (std::size_t c = 0; c < bar.q.size(); ++c)
            costates[j].workpiece.strain[c] += weight * bar.q[c];
          PhysicsBar physics_bar(run.model.dies);
          if (const auto d = run.objectives[o].at_end->target_die(); d != invalid_index)
            add(weight, bar.target, physics_bar.dies[d].vertices);
          for (std::size_t d = 0; d < run.model.dies.size(); ++d)
          {
            physics_bar.dies[d].displacement = weight * bar.dies[d].displacement;
            add(weight, bar.dies[d].vertices, physics_bar.dies[d].vertices);
          }
          reverse_at_stroke(run.process, {end.stroke, 0.}, 0., physics_bar, costates[j].process.part());
        }
      }
      return costates;
    }

    /// What objectives of the path give to increment i.
    AdjointSource source_of(const RecordedForging               &run,
                            const std::vector<PathRows<double>> &rows,
                            const std::vector<PathRows<double>> &rows_bar,
                            const std::vector<Combination>      &combinations,
                            const unsigned int                   i)
    {
      return [&run, &rows, &rows_bar, &combinations, i](
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
            bar.physics.dt += weight * dt_bar(rows[o][i], rows_bar[o][i]);
        }
      };
    }
  } // namespace

  AdjointSweep adjoint_sweep(const RecordedForging               &run,
                             const std::vector<PathRows<double>> &rows,
                             const ForgingState                  &end,
                             const std::vector<Combination>      &combinations)
  {
    AssertDimension(end.increments, run.n);
    AssertDimension(rows.size(), run.objectives.size());
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
    WorkpieceState<3, double> state    = end.workpiece; // at the end, then at the start of each increment
    std::vector<unsigned int> remeshed = end.remeshed;
    std::shared_ptr<Leg>      leg      = end.leg;
    AdjointSweep              sweep;
    leg->increment.mechanics.forget();
    for (unsigned int i = end.increments; i-- > 0;)
    {
      const IncrementRecord     &record = run.source(i);
      const unsigned int         before = leg->system.n_solves;
      const NodalVectors<double> X      = leg->increment.mechanics.retreat(run.process, state.X, record);
      if (!end.starts.empty())
        state = end.starts[i];
      state.X = X;
      leg->increment.reverse(
        run.process, state, record, source_of(run, rows, rows_bar, combinations, i), costates);
      sweep.linear_solves += leg->system.n_solves - before;
      if (record.remesh)
      {
        const auto remesh = record.remesh;
        remeshed.pop_back();
        leg = remeshed.empty()
                ? run.first
                : std::make_shared<Leg>(run.source(remeshed.back()).remesh->mesh, run.model, run.timings);
        leg->increment.mechanics.forget();
        state   = end.left_behind[remeshed.size()];
        state.X = remesh->X_before;
        for (Costate &costate : costates)
          costate.workpiece = reverse_change_mesh(leg->scene.mesh, *remesh, state, costate.workpiece);
      }
    }
    for (Costate &costate : costates)
      sweep.gradients.push_back({std::move(costate.workpiece.X), costate.process.complete()});
    return sweep;
  }

  std::vector<Dual>
  tangent_sweep(const RecordedForging &run, const Process<Dual> &process, NodalVectors<Dual> X)
  {
    AssertDimension(X.size(), run.first->scene.mesh.n_nodes());
    AssertDimension(process.dies.size(), run.model.dies.size());
    std::shared_ptr<Leg>        leg = run.first;
    std::vector<PathRows<Dual>> rows(run.objectives.size());
    auto                        state = initial_state<3>(std::move(X), leg->scene.mesh.n_cells());
    double                      end   = 0.;
    for (unsigned int i = 0; i < run.n; ++i)
    {
      const IncrementRecord &record = run.source(i);
      if (record.remesh)
      {
        state = change_mesh(leg->scene.mesh, *record.remesh, state);
        leg   = std::make_shared<Leg>(record.remesh->mesh, run.model, run.timings);
      }
      end = record.stroke + record.step;
      for (auto &of_objective : rows)
        of_objective.push_back(row_of(record, process));
      leg->increment.tangent(
        process,
        record,
        [&](const StageView<Dual> &view, const Dual &) {
          for (std::size_t o = 0; o < run.objectives.size(); ++o)
            if (run.objectives[o].path)
              add_integrals(*run.objectives[o].path, view, rows[o].back());
        },
        state);
    }
    const auto        dies = process.at_stroke(end).dies;
    std::vector<Dual> values;
    for (std::size_t o = 0; o < run.objectives.size(); ++o)
      if (run.objectives[o].path)
        values.push_back(run.objectives[o].path->value(rows[o]));
      else
      {
        const FinalObjective &objective = *run.objectives[o].at_end;
        const auto            view      = final_view(objective, leg->scene, state.X, state.strain, dies);
        values.push_back(objective.value(sum_over_ranks(objective.integrals(view), run.model.comm)));
      }
    return values;
  }
} // namespace retroforge
