// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/time/objective_trace.h>

namespace retroforge
{
  ObjectiveTrace::ObjectiveTrace(const Objectives           &objectives,
                                 const Process<double>      &process,
                                 std::vector<FinalDecisions> decisions)
      : objectives_(objectives)
      , process_(process)
      , recorded_{std::vector<PathRows<double>>(objectives.size()), std::move(decisions)}
  {
    Assert(recorded_.decisions.empty() || recorded_.decisions.size() == objectives.size(),
           dealii::ExcMessage("decisions are of each objective"));
  }

  template <typename Number>
  PathRow<Number>
  row_of(const IncrementRecord &record, const Process<Number> &process, const MovedEnds<Number> &ends)
  {
    const Number    dt = process.duration(place(record));
    PathRow<Number> row =
      recorded_row<Number>({},
                           dt,
                           process.whole_time(record.stroke, record.operation),
                           value_of(process.whole_stroke(record.stroke, record.operation)),
                           record.step,
                           record.operation);
    row.stroke += ends.start;
    row.step += ends.end - ends.start;
    row.time += dt * ends.start / record.step;
    row.dt *= row.step / record.step;
    return row;
  }

  template PathRow<double>
                         row_of(const IncrementRecord &, const Process<double> &, const MovedEnds<double> &);
  template PathRow<Dual> row_of(const IncrementRecord &, const Process<Dual> &, const MovedEnds<Dual> &);

  MovedEnds<double> reverse_row(const IncrementRecord &record, const double dt, const PathRow<double> &bar)
  {
    const double end = bar.step + bar.dt * dt / record.step;
    return {bar.stroke + bar.time * dt / record.step - end, end};
  }

  template <typename Number>
  FinalView<Number> final_view(const FinalObjective            &objective,
                               const Scene                     &scene,
                               const WorkpieceState<3, Number> &workpiece,
                               const Physics<Number>           &physics)
  {
    AssertDimension(workpiece.X.size(), scene.mesh.n_nodes());
    AssertDimension(workpiece.strain.size(), scene.mesh.n_cells());
    AssertDimension(physics.dies.size(), scene.dies.size());
    const auto        &dies  = physics.dies;
    const unsigned int d     = objective.target_die();
    const bool         moved = d != invalid_index && !dies[d].vertices.empty();
    return {scene,
            workpiece.X,
            workpiece.strain,
            dies,
            moved ? &dies[d].vertices : nullptr,
            workpiece.temperature.empty() ? nullptr : &workpiece.temperature,
            workpiece.damage.empty() ? nullptr : &workpiece.damage,
            workpiece.skin.empty() ? nullptr : &workpiece.skin,
            physics.heat.conducts() ? &physics.heat : nullptr};
  }

  template FinalView<double> final_view(const FinalObjective &,
                                        const Scene &,
                                        const WorkpieceState<3, double> &,
                                        const Physics<double> &);
  template FinalView<Dual>
  final_view(const FinalObjective &, const Scene &, const WorkpieceState<3, Dual> &, const Physics<Dual> &);

  void ObjectiveTrace::add(const IncrementEvent &event)
  {
    for (std::size_t j = 0; j < objectives_.size(); ++j)
      if (const auto &objective = objectives_[j].path)
      {
        recorded_.rows[j].push_back(row_of<double>(event.record, process_, event.ends));
        for (const auto &stage : event.solved.stages)
          add_integrals(*objective, stage->view(), recorded_.rows[j].back());
      }
  }

  namespace
  {
    using Evaluation = ObjectiveTrace::Evaluation;

    FinalView<double>
    view_of(const FinalObjective &objective, const ForgingState &state, const Physics<double> &physics)
    {
      return final_view(objective, state.epoch->scene, state.workpiece, physics);
    }

    Evaluation evaluated(const PathObjective &objective, const PathRows<double> &rows)
    {
      return {objective.value(rows), objective.parts(rows), objective.details(rows)};
    }

    Evaluation
    evaluated(const FinalObjective &objective, const FinalView<double> &view, const FinalDecisions &decisions)
    {
      const auto b = objective.integrals(view, decisions).complete();
      return {objective.value(b, decisions), objective.parts(b), objective.details(b, decisions)};
    }

    const double undefined = std::numeric_limits<double>::quiet_NaN();

    Evaluation evaluated_so_far(const PathObjective &objective, const PathRows<double> &rows)
    try
    {
      return evaluated(objective, rows);
    }
    catch (const Error &)
    {
      return {undefined, objective.parts(rows), objective.details(rows)};
    }

    Evaluation evaluated_so_far(const FinalObjective &objective, const FinalView<double> &view)
    try
    {
      return evaluated(objective, view, objective.decide(view));
    }
    catch (const Error &)
    {
      return {undefined, {}, {}};
    }
  } // namespace

  void ObjectiveTrace::decide(const ForgingState &state)
  {
    const auto physics = process_.at_stroke(state.stroke, state.operation);
    recorded_.decisions.assign(objectives_.size(), {});
    for (std::size_t j = 0; j < objectives_.size(); ++j)
      if (const auto &objective = objectives_[j].at_end)
        recorded_.decisions[j] = objective->decide(view_of(*objective, state, physics));
  }

  std::vector<Evaluation> ObjectiveTrace::evaluate(const ForgingState &state) const
  {
    AssertDimension(recorded_.decisions.size(), objectives_.size());
    const auto              physics = process_.at_stroke(state.stroke, state.operation);
    std::vector<Evaluation> evaluations;
    for (std::size_t j = 0; j < objectives_.size(); ++j)
      if (const auto &path = objectives_[j].path)
        evaluations.push_back(evaluated(*path, recorded_.rows[j]));
      else
        evaluations.push_back(evaluated(
          *objectives_[j].at_end, view_of(*objectives_[j].at_end, state, physics), recorded_.decisions[j]));
    return evaluations;
  }

  std::vector<double> ObjectiveTrace::values(const ForgingState &state) const
  {
    std::vector<double> values;
    for (const Evaluation &evaluation : evaluate(state))
      values.push_back(evaluation.value);
    return values;
  }

  std::vector<Evaluation> ObjectiveTrace::evaluate_so_far(const ForgingState &state) const
  {
    const auto              physics = process_.at_stroke(state.stroke, state.operation);
    std::vector<Evaluation> evaluations;
    for (std::size_t j = 0; j < objectives_.size(); ++j)
      if (const auto &path = objectives_[j].path)
        evaluations.push_back(evaluated_so_far(*path, recorded_.rows[j]));
      else
        evaluations.push_back(
          evaluated_so_far(*objectives_[j].at_end, view_of(*objectives_[j].at_end, state, physics)));
    return evaluations;
  }
} // namespace retroforge
