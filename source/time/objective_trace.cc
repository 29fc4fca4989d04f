// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/time/objective_trace.h>

namespace retroforge
{
  ObjectiveTrace::ObjectiveTrace(const Objectives      &objectives,
                                 const ForgingModel    &model,
                                 const Process<double> &process)
      : objectives_(objectives), model_(model), process_(process), rows_(objectives.size())
  {
  }

  template <typename Number>
  PathRow<Number> row_of(const IncrementRecord &record, const Process<Number> &process)
  {
    return {{}, process.time(record.step), process.time(record.stroke), record.stroke, record.step};
  }

  template PathRow<double> row_of(const IncrementRecord &, const Process<double> &);
  template PathRow<Dual>   row_of(const IncrementRecord &, const Process<Dual> &);

  template <typename Number>
  FinalView<Number> final_view(const FinalObjective                &objective,
                               const Scene                         &scene,
                               const NodalVectors<Number>          &X,
                               const std::vector<Number>           &strain,
                               const std::vector<DieState<Number>> &dies)
  {
    AssertDimension(X.size(), scene.mesh.n_nodes());
    AssertDimension(strain.size(), scene.mesh.n_cells());
    AssertDimension(dies.size(), scene.dies.size());
    const unsigned int d     = objective.target_die();
    const bool         moved = d != invalid_index && !dies[d].vertices.empty();
    return {scene, X, strain, dies, moved ? &dies[d].vertices : nullptr};
  }

  template FinalView<double> final_view(const FinalObjective &,
                                        const Scene &,
                                        const NodalVectors<double> &,
                                        const std::vector<double> &,
                                        const std::vector<DieState<double>> &);
  template FinalView<Dual>   final_view(const FinalObjective &,
                                        const Scene &,
                                        const NodalVectors<Dual> &,
                                        const std::vector<Dual> &,
                                        const std::vector<DieState<Dual>> &);

  void ObjectiveTrace::add(const IncrementEvent &event)
  {
    for (std::size_t j = 0; j < objectives_.size(); ++j)
      if (const auto &objective = objectives_[j].path)
      {
        rows_[j].push_back(row_of<double>(event.record, process_));
        for (const auto &stage : event.solved.stages)
          add_integrals(*objective, stage->view(), rows_[j].back());
      }
  }

  std::vector<double>
  ObjectiveTrace::values(const ForgingState &state, const bool decide, const bool complete) const
  {
    const auto          dies = process_.at_stroke(state.stroke).dies;
    std::vector<double> values;
    for (std::size_t j = 0; j < objectives_.size(); ++j)
      try
      {
        if (objectives_[j].path)
          values.push_back(objectives_[j].path->value(rows_[j]));
        else
        {
          const auto view = final_view(
            *objectives_[j].at_end, state.leg->scene, state.workpiece.X, state.workpiece.strain, dies);
          if (decide)
            objectives_[j].at_end->decide(view);
          values.push_back(objectives_[j].at_end->value(
            sum_over_ranks(objectives_[j].at_end->integrals(view), model_.comm)));
        }
      }
      catch (const Error &)
      {
        if (complete)
          throw;
        values.push_back(std::numeric_limits<double>::quiet_NaN());
      }
    return values;
  }

  std::vector<ObjectiveTrace::Diagnostics> ObjectiveTrace::diagnostics(const ForgingState &state) const
  {
    const auto               dies = process_.at_stroke(state.stroke).dies;
    std::vector<Diagnostics> diagnostics;
    for (const NamedObjective &objective : objectives_)
      if (objective.path)
      {
        const PathRows<double> &rows = rows_[diagnostics.size()];
        diagnostics.push_back({objective.path->parts(rows), objective.path->details(rows)});
      }
      else
      {
        const auto view =
          final_view(*objective.at_end, state.leg->scene, state.workpiece.X, state.workpiece.strain, dies);
        const auto b = sum_over_ranks(objective.at_end->integrals(view), model_.comm);
        diagnostics.push_back({objective.at_end->parts(b), objective.at_end->details(b)});
      }
    return diagnostics;
  }
} // namespace retroforge
