// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/level_gaps.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/core/text.h>
#include <retroforge/mesh/parts_quality.h>
#include <retroforge/output/console.h>
#include <retroforge/run/run_output.h>
#include <retroforge/run/run_summary.h>

#include <cmath>
#include <cstdio>
#include <utility>

namespace retroforge
{
  namespace
  {
    double whole_stroke(const Process<double> &process, const StrokeStep &at)
    {
      return process.whole_stroke(at.stroke, at.operation);
    }

    StrokeStep place(const ForgingState &state)
    {
      return {state.stroke, 0., state.operation};
    }
  } // namespace

  RunOutput::RunOutput(const Case            &forging_case,
                       const Process<double> &process,
                       const WholePart       &whole,
                       const ObjectiveTrace  &trace,
                       Timings               &timings)
      : case_(forging_case)
      , process_(process)
      , whole_(whole)
      , trace_(trace)
      , timings_(timings)
      , time_left_(whole_stroke(process, process.end()))
      , fields_(forging_case.comm,
                forging_case.command.output_directory,
                forging_case.model,
                process,
                forging_case.billet,
                forging_case.X_0)
  {
    if (forging_case.parameters.output.every != 0u)
    {
      const auto timing = timings_.scope("output");
      fields_.add_billet();
    }
    const std::string &folder = forging_case.command.output_directory;
    if (dealii::Utilities::MPI::this_mpi_process(forging_case.comm) != 0)
      return;
    history_    = std::make_unique<History>(folder + "/history.csv");
    objectives_ = std::make_unique<ObjectiveHistory>(folder + "/objectives.csv");
    print_head(whole);
  }

  void RunOutput::begin()
  {
    seconds_ = timings_.seconds("total");
  }

  bool RunOutput::is_due(const ForgingState &state, const unsigned int every) const
  {
    const bool at_end =
      whole_stroke(process_, place(state)) >= whole_stroke(process_, process_.end()) * (1. - 1e-9);
    return every > 0 && (state.increments % every == 0 || at_end);
  }

  bool RunOutput::shows(const IncrementEvent &event) const
  {
    if (case_.parameters.output.every)
      return is_due(event.state, *case_.parameters.output.every);
    constexpr double n_pictures = 20.;
    const auto       interval   = [&](const StrokeStep &at) {
      return std::floor(n_pictures * whole_stroke(process_, at) / whole_stroke(process_, process_.end()) +
                        1e-6);
    };
    return interval(place(event.state)) > interval(retroforge::place(event.record));
  }

  void RunOutput::add(const IncrementEvent &event)
  {
    for (std::size_t p = 0; p < event.record.pairs.size(); ++p)
      if (event.record.solves.back().active[p])
        touched_.insert(event.record.pairs[p].die);
    watch_edges(event);
    decisions_.push_back({whole_stroke(process_, retroforge::place(event.record)),
                          whole_stroke(process_, place(event.state)),
                          event.record.remesh != nullptr,
                          event.record.cuts});
    if (is_due(event.state, case_.parameters.objectives.every))
      add_objectives(event.state);
    const auto       timing = timings_.scope("output");
    const HistoryRow row    = row_of(event);
    if (history_)
    {
      history_->add(row);
      print(event, row);
    }
    fields_.follow(event);
    if (shows(event))
      fields_.add(event);
  }

  void RunOutput::add_objectives(const ForgingState &state)
  {
    const auto              timing      = timings_.scope("objectives");
    const Objectives       &objectives  = case_.objectives;
    const auto              evaluations = trace_.evaluate_so_far(state);
    std::vector<NamedValue> columns;
    for (std::size_t j = 0; j < objectives.size(); ++j)
    {
      const std::string unit = " [" + objectives[j].unit() + "]";
      columns.emplace_back(objectives[j].name + unit, evaluations[j].value);
      for (const auto *numbers : {&evaluations[j].parts, &evaluations[j].details})
        for (const auto &[name, value] : *numbers) // some have a unit of their own
          columns.emplace_back(objectives[j].name + ": " + name + (name.back() == ']' ? "" : unit), value);
    }
    if (objectives_)
      objectives_->add(whole_stroke(process_, place(state)), columns);
  }

  void RunOutput::watch_edges(const IncrementEvent &event)
  {
    const EdgeFit fit =
      edge_fit(event.X_before, event.record.contact.ramp_in(event.record.step), event.solved.start->contact);
    if (fit.spanning > spanned_.spanning)
      spanned_ = {fit.touching,
                  fit.spanning,
                  fit.largest,
                  event.state.stroke,
                  {{fit.place[0], fit.place[1], fit.place[2]}},
                  case_.model.dies[fit.die].name};
  }

  HistoryRow RunOutput::row_of(const IncrementEvent &event)
  {
    const ForgingState      &state = event.state;
    const Scene             &scene = state.epoch->scene;
    const ReplicatedEntries &cells = scene.discretization.cells();
    const double             size  = volume(scene.mesh, state.workpiece.X, cells);
    const Summary::Depth     depth = depth_in_dies(case_, process_, state);
    if (!(depth.depth <= deepest_.depth))
      deepest_ = depth;
    const unsigned int leading  = case_.nominal.operations[state.operation].leading_die;
    const Vec3        &velocity = case_.nominal.dies[leading].velocity;
    const double       force    = event.record.forces[leading] * velocity / velocity.norm();
    const double       energy   = state.energy.total();
    return {state.increments,
            event.time,
            whole_stroke(process_, place(state)),
            force,
            energy,
            size,
            minimum_quality(scene.mesh, state.workpiece.X, cells),
            depth.depth,
            event.record.newton,
            event.record.krylov,
            whole_.force * force,
            whole_.copies * energy,
            whole_.copies * size,
            balance_.add(event.record)};
  }

  namespace
  {
    /// What comes before the stroke of an operation, where heat flows.
    std::string waits(const Process<double> &process, const unsigned int operation, const Case &of)
    {
      std::vector<std::string> parts;
      const Waiting<double>   &waiting = process.operations[operation].waiting;
      if (process.heat.conducts() && waiting.transfer > 0.)
        parts.push_back(as_text(waiting.transfer) + " s in the surroundings");
      if (process.heat.conducts() && waiting.dwell > 0.)
        parts.push_back(as_text(waiting.dwell) + " s on die " + of.model.dies[waiting.resting_die].name);
      return join(parts);
    }
  } // namespace

  void RunOutput::print(const IncrementEvent &event, const HistoryRow &row)
  {
    const TetMesh &mesh = event.state.epoch->scene.mesh;
    if (event.record.stroke == 0.)
      if (const std::string text = waits(process_, event.record.operation, case_); !text.empty())
        std::printf("      before the stroke: %s\n", text.c_str());
    if (event.record.remesh)
      std::printf("      remeshed: %u nodes, %u tetrahedra\n", mesh.n_nodes(), mesh.n_cells());
    if (event.record.cuts > 0 && !case_.parameters.press.steps.empty())
      std::printf("      not kept whole: halved %u time(s)\n", event.record.cuts);
    if (!std::isnan(seconds_)) // solved, not restored
    {
      const double now = timings_.seconds("total");
      time_left_.add(event.record.step, now - std::exchange(seconds_, now));
    }
    print_increment(row, time_left_.seconds(row.stroke));
  }

  void RunOutput::add_failed(const ForgingState &state)
  {
    fields_.add_failed(state);
  }

  std::vector<std::string> RunOutput::untouched_dies() const
  {
    std::vector<std::string> names;
    for (unsigned int d = 0; d < case_.model.dies.size(); ++d)
      if (touched_.count(d) == 0)
        names.push_back(case_.model.dies[d].name);
    return names;
  }
} // namespace retroforge
