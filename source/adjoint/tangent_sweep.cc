// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/adjoint/sweep.h>
#include <retroforge/steps/change_of_mesh.h>
#include <retroforge/steps/moved_ends.h>

namespace retroforge
{
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
