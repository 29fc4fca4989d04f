// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/adjoint/sweep.h>
#include <retroforge/steps/change_of_mesh.h>
#include <retroforge/steps/moved_ends.h>

#include <deal.II/base/mpi.h>

#include <numeric>
#include <optional>

namespace retroforge
{
  namespace
  {
    /// to += weight * from, number by number.
    template <typename Aggregate>
    void add(const double weight, const Aggregate &from, Aggregate &to)
    {
      for_each_number([weight](const double &x, double &y) { y += weight * x; }, from, to);
    }

    /// Derivatives of objective o, one of the end.
    FinalBar reverse_at_end(const RecordedForging &run, const ForgingState &end, const std::size_t o)
    {
      const FinalObjective &objective = *run.objectives[o].at_end;
      const FinalDecisions &decisions = run.traced.decisions[o];
      const auto            physics   = run.process.at_stroke(end.stroke, end.operation);
      const auto            view      = final_view(objective, end.epoch->scene, end.workpiece, physics);
      const auto            integrals = objective.integrals(view, decisions).complete();
      return objective.derivatives(view, decisions, objective.reverse_value(integrals, decisions)).complete();
    }

    /// The costates of the workpiece at the end of the run.
    std::vector<Costate> start_costates(const RecordedForging          &run,
                                        const ForgingState             &end,
                                        const std::vector<Combination> &combinations)
    {
      std::vector<Costate> costates(
        combinations.size(),
        {zero_costate<3>(end.workpiece.X.size(),
                         end.workpiece.strain.size(),
                         run.process.heat.warms(),
                         run.process.heat.conducts()
                           ? NodeSkins<double>::none(end.workpiece.X.size(), run.model.dies.size())
                           : NodeSkins<double>(),
                         run.process.material.is_damaged()),
         {no_process_derivatives(run.process, run.model.dies), run.model.comm}});
      for (std::size_t o = 0; o < run.objectives.size(); ++o)
      {
        if (!run.objectives[o].at_end)
          continue;
        const FinalBar bar = reverse_at_end(run, end, o);
        for (std::size_t j = 0; j < costates.size(); ++j)
        {
          const double weight = combinations[j].weights[o];
          if (weight == 0.)
            continue;
          WorkpieceState<3, double> &workpiece = costates[j].workpiece;
          add<NodalVectors<double>>(weight, bar.X, workpiece.X);
          add<std::vector<double>>(weight, bar.q, workpiece.strain);
          add<std::vector<double>>(weight, bar.T, workpiece.temperature);
          add(weight, bar.skin, workpiece.skin);
          add<std::vector<double>>(weight, bar.damage, workpiece.damage);
          PhysicsBar physics_bar(run.model.dies);
          add(weight, bar.dies, physics_bar.dies);
          if (const auto d = run.objectives[o].at_end->target_die(); d != invalid_index)
            add(weight, bar.target, physics_bar.dies[d].vertices);
          costates[j].process.add_once([&](Process<double> &part) {
            reverse_over(run.process, {end.stroke, 0., end.operation}, 0., physics_bar, part);
          });
        }
      }
      return costates;
    }

    /// What objectives of the path give to increment i.
    AdjointSource source_of(const RecordedForging               &run,
                            const std::vector<PathRows<double>> &rows_bar,
                            const std::vector<Combination>      &combinations,
                            const unsigned int                   i)
    {
      return [&run, &rows_bar, &combinations, i](
               const std::size_t j, const EquilibriumView<double> &view, EquilibriumBar &bar) {
        for (std::size_t o = 0; o < run.objectives.size(); ++o)
        {
          const double weight = combinations[j].weights[o] * view.weight;
          if (!run.objectives[o].path || weight == 0.)
            continue;
          std::vector<double> weights = rows_bar[o][i].integrals;
          for (double &w : weights)
            w *= weight;
          run.objectives[o].path->reverse_integrals(view, weights, bar);
        }
      };
    }

    /// What they take from the times of the increment, which all ranks know.
    /// @return what they take from its ends
    MovedEnds<double> reverse_rows(const RecordedForging               &run,
                                   const std::vector<PathRows<double>> &rows_bar,
                                   const Combination                   &combination,
                                   const unsigned int                   i,
                                   const IncrementRecord               &record,
                                   Costate                             &costate)
    {
      PhysicsBar        bar(run.model.dies);
      MovedEnds<double> ends_bar;
      const double      dt = run.process.duration(place(record));
      for (std::size_t o = 0; o < run.objectives.size(); ++o)
        if (run.objectives[o].path)
        {
          const double weight = combination.weights[o];
          bar.dt += weight * rows_bar[o][i].dt;
          bar.time += weight * rows_bar[o][i].time;
          const MovedEnds<double> of_row = reverse_row(record, dt, rows_bar[o][i]);
          ends_bar.start += weight * of_row.start;
          ends_bar.end += weight * of_row.end;
        }
      if (bar.dt != 0. || bar.time != 0.)
        costate.process.add_once(
          [&](Process<double> &part) { reverse_over(run.process, place(record), 0., bar, part); });
      return ends_bar;
    }

    /// Positions at the starts of the increments from one, at whose start they are given, up to another. They are those of the run to the
    /// bit: where nodes stand on dies contact has kinks, and is to be differentiated on the side where the run was.
    std::vector<NodalVectors<double>> positions_of(const RecordedForging &run,
                                                   const MeshEpoch       &epoch,
                                                   const unsigned int     from,
                                                   const unsigned int     to)
    {
      std::vector<NodalVectors<double>> starts = {from > 0 || run.record(from).remesh ? epoch.scene.mesh.X
                                                                                      : run.X_0};
      for (unsigned int i = from; i + 1 < to; ++i)
        starts.push_back(
          epoch.increment.mechanics.positions_after(run.process, starts.back(), run.record(i)));
      return starts;
    }

    /// Costates that take what falls on an increment apart from what fell on the process before.
    std::vector<Costate> apart(const RecordedForging &run, std::vector<Costate> &costates)
    {
      std::vector<Costate> parts;
      for (Costate &costate : costates)
        parts.push_back({std::move(costate.workpiece),
                         {no_process_derivatives(run.process, run.model.dies), run.model.comm}});
      return parts;
    }

    /// Takes such costates together again. Returns what fell on the ends of the increment.
    MovedEnds<double>
    together(const RecordedForging &run, const IncrementRecord &record, Costate &&part, Costate &costate)
    {
      costate.workpiece         = std::move(part.workpiece);
      const Process<double> bar = part.process.complete();
      costate.process.add_once([&](Process<double> &to) { add<Process<double>>(1., bar, to); });
      return reverse_moved_ends(run.process, place(record), bar);
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
    std::vector<Costate>       costates = start_costates(run, end, combinations);
    WorkpieceState<3, double>  state    = end.workpiece; // at the end, then at the start of each increment
    std::vector<unsigned int>  remeshed = end.remeshed;
    std::shared_ptr<MeshEpoch> epoch    = end.epoch;
    AdjointSweep               sweep;

    // Derivatives in how far the end of the increment at hand moves; 0 where it does not.
    std::vector<double> end_bar(costates.size(), 0.);
    // In the positions at which the mesh at hand was made.
    std::vector<NodalVectors<double>> made_bar(costates.size(), NodalVectors<double>(state.X.size()));

    std::vector<NodalVectors<double>> starts; // of the increments that are left on the mesh at hand

    const IncrementMemory no_history;
    epoch->increment.mechanics.forget();
    for (unsigned int i = end.increments; i-- > 0;)
    {
      // Of the increment before, on its mesh, and as its operation's: the next one begins at rest.
      NodeVectorField<3, double> velocity;
      unsigned int               operation = 0;
      if (i > 0)
      {
        const IncrementRecord &earlier = run.record(i - 1);
        velocity                       = epoch->increment.mechanics.mean_velocity(earlier);
        operation                      = earlier.operation;
      }
      // Its own: of a recording on the disk the next one that is read takes the place of this one.
      const IncrementRecord record = run.record(i);
      if (record.operation != operation)
        velocity.clear();
      const unsigned int before = epoch->system.n_solves;
      if (starts.empty())
        starts = positions_of(run, *epoch, remeshed.empty() ? 0 : remeshed.back(), i + 1);
      const NodalVectors<double> X = std::move(starts.back());
      starts.pop_back();
      if (!end.remembered.empty())
        state = end.remembered[i].start.get();
      state.X        = X;
      state.velocity = velocity;
      if (record.remesh && !velocity.empty())
        state.velocity = record.remesh->transfer.apply<Vec3>(velocity);
      const bool                  follows     = !run.rules.empty();
      const bool                  moves_start = follows && i > 0 && record.operation == operation;
      std::vector<Costate>        parts;
      std::optional<FollowingEnd> following;
      if (follows)
      {
        parts = apart(run, costates);
        following.emplace(epoch->scene.mesh,
                          remeshed.empty() ? run.X_0 : epoch->scene.mesh.X,
                          X,
                          epoch->increment.mechanics.mean_velocity(record),
                          run.process,
                          place(record),
                          run.rules[i]);
      }
      std::vector<Costate> &of_increment = parts.empty() ? costates : parts;
      epoch->increment.reverse(run.process,
                               state,
                               end.remembered.empty() ? no_history : end.remembered[i],
                               record,
                               source_of(run, rows_bar, combinations, i),
                               of_increment);
      for (std::size_t j = 0; j < costates.size(); ++j)
      {
        const MovedEnds<double> of_rows =
          reverse_rows(run, rows_bar, combinations[j], i, record, costates[j]);
        if (parts.empty())
          continue;
        const MovedEnds<double> of_work  = together(run, record, std::move(parts[j]), costates[j]);
        const double            of_start = following->reverse_moved(
          end_bar[j] + of_rows.end + of_work.end, made_bar[j], costates[j].workpiece.X);
        end_bar[j] = moves_start ? of_start + of_rows.start + of_work.start : 0.;
      }
      if (follows && (record.remesh || i == 0))
        for (std::size_t j = 0; j < costates.size(); ++j)
        {
          for (std::size_t k = 0; k < made_bar[j].size(); ++k)
            costates[j].workpiece.X[k] += made_bar[j][k];
          made_bar[j].assign(record.remesh ? record.remesh->X_before.size() : 0, Vec3());
        }
      sweep.linear_solves += epoch->system.n_solves - before;
      if (record.remesh)
      {
        const auto remesh = record.remesh;
        remeshed.pop_back();
        epoch =
          remeshed.empty()
            ? run.first
            : std::make_shared<MeshEpoch>(run.record(remeshed.back()).remesh->mesh, run.model, run.timings);
        epoch->increment.mechanics.forget();
        state          = end.left_behind[remeshed.size()];
        state.X        = remesh->X_before;
        state.velocity = velocity;
        const StrokeStep at{record.stroke, 0., record.operation};
        const auto       states = run.process.over(at).dies;
        MovingTransfer   moving(epoch->scene.mesh, remesh->X_before, remesh->mesh, remesh->transfer);
        const auto       following = following_mesh(run.meshes_follow, i, *remesh);
        for (std::size_t j = 0; j < costates.size(); ++j)
        {
          PhysicsBar bar(run.model.dies);
          costates[j].workpiece = reverse_change_mesh(epoch->scene.mesh,
                                                      *remesh,
                                                      state,
                                                      run.model.dies,
                                                      states,
                                                      costates[j].workpiece,
                                                      moving,
                                                      bar.dies,
                                                      following.get());
          costates[j].process.add_once(
            [&](Process<double> &part) { reverse_over(run.process, at, 0., bar, part); });
          if (moves_start)
          {
            Process<double> process_bar = no_process_derivatives(run.process, run.model.dies);
            reverse_over(run.process, at, 0., bar, process_bar);
            end_bar[j] += reverse_moved_ends(run.process, at, process_bar).start;
          }
        }
      }
    }
    for (Costate &costate : costates)
    {
      const auto  &T_bar = costate.workpiece.temperature;
      const double sum   = std::accumulate(T_bar.begin(), T_bar.end(), 0.);
      costate.process.add_once([&](Process<double> &part) { part.material.initial.temperature += sum; });
      sweep.gradients.push_back({std::move(costate.workpiece.X), costate.process.complete()});
    }
    return sweep;
  }

  std::vector<Dual>
  tangent_sweep(const RecordedForging &run, const Process<Dual> &process, NodalVectors<Dual> X)
  {
    AssertDimension(X.size(), run.first->scene.mesh.n_nodes());
    AssertDimension(process.dies.size(), run.model.dies.size());
    std::shared_ptr<MeshEpoch>  epoch = run.first;
    std::vector<PathRows<Dual>> rows(run.objectives.size());
    auto                        state  = workpiece_before(process, std::move(X), epoch->scene.mesh.n_cells());
    NodalVectors<Dual>          X_made = state.X;
    StrokeStep                  end{0., 0.};
    MovedEnds<Dual>             ends;
    for (unsigned int i = 0; i < run.n; ++i)
    {
      const IncrementRecord &record = run.record(i);
      if (record.operation != end.operation)
        state.velocity.clear();
      if (record.remesh)
      {
        const StrokeStep at{record.stroke, 0., record.operation};
        const auto       dies      = with_moved_ends(process, at, {ends.end, ends.end}).over(at).dies;
        const auto       following = following_mesh(run.meshes_follow, i, *record.remesh);
        state  = change_mesh(epoch->scene.mesh, *record.remesh, state, run.model.dies, dies, following.get());
        epoch  = std::make_shared<MeshEpoch>(record.remesh->mesh, run.model, run.timings);
        X_made = state.X;
      }
      end  = place(record);
      ends = {ends.end, Dual(0.)};
      if (!run.rules.empty())
      {
        NodalVectors<double> made, X;
        convert(X_made, made);
        convert(state.X, X);
        const auto V = epoch->increment.mechanics.mean_velocity(record);
        ends.end     = FollowingEnd(epoch->scene.mesh, made, X, V, run.process, end, run.rules[i])
                     .moved(ends.start, X_made, state.X);
      }
      const Process<Dual> moved = with_moved_ends(process, end, ends);
      for (auto &of_objective : rows)
        of_objective.push_back(row_of(record, process, ends));
      epoch->increment.tangent(
        moved,
        record,
        [&](const EquilibriumView<Dual> &view, const Dual &) {
          for (std::size_t o = 0; o < run.objectives.size(); ++o)
            if (run.objectives[o].path)
              add_integrals(*run.objectives[o].path, view, rows[o].back());
        },
        state);
    }
    const auto        physics = process.at_stroke(end.stroke + end.step, end.operation);
    std::vector<Dual> values;
    for (std::size_t o = 0; o < run.objectives.size(); ++o)
      if (run.objectives[o].path)
        values.push_back(run.objectives[o].path->value(rows[o]));
      else
      {
        const FinalObjective &objective = *run.objectives[o].at_end;
        const auto            view      = final_view(objective, epoch->scene, state, physics);
        const FinalDecisions &decisions = run.traced.decisions[o];
        values.push_back(objective.value(objective.integrals(view, decisions).complete(), decisions));
      }
    return values;
  }
} // namespace retroforge
