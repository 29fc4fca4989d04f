// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/case/restart_rules.h>
#include <retroforge/case/scene_checks.h>
#include <retroforge/core/error.h>
#include <retroforge/core/version.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/output/results_folder.h>
#include <retroforge/output/safe_file.h>
#include <retroforge/run/forward_run.h>
#include <retroforge/run/slope_trust.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace retroforge
{
  namespace
  {
    /// With dies of the shape that a process gives them; the process is left without.
    ForgingModel with_dies(ForgingModel model, Process<double> &process)
    {
      for (std::size_t d = 0; d < model.dies.size(); ++d)
        if (auto vertices = std::exchange(process.dies[d].vertices, {}); !vertices.empty())
          model.dies[d] = model.dies[d].moved(std::move(vertices));
      return model;
    }

    void set_numerics(const Parameters &numerics, ForgingModel &model)
    {
      model.step          = numerics.step_model();
      model.newton        = numerics.newton;
      model.linear_solver = numerics.linear_solver;
    }

    /// Where a segment of the run ends.
    StrokeStep end_of(const ForgingProblem &problem, const std::size_t segment)
    {
      if (segment + 1 == problem.segments.size())
        return problem.process.end();
      const RecordedInput &next = problem.segments[segment + 1].input;
      return {next.stroke, 0., next.operation};
    }

    /// A mesh that someone else owns.
    std::shared_ptr<const TetMesh> borrowed(const TetMesh &mesh)
    {
      return {std::shared_ptr<const TetMesh>(), &mesh};
    }
  } // namespace

  ForgingProblem::ForgingProblem(const Case          &forging_case,
                                 Process<double>      at_process,
                                 NodalVectors<double> initial)
      : parameters(forging_case.parameters)
      , billet(borrowed(forging_case.billet))
      , nominal_billet(borrowed(forging_case.nominal_billet))
      , X_0(std::move(initial))
      , model(with_dies(forging_case.model, at_process))
      , process(std::move(at_process))
      , earlier(earlier_start(parameters, *billet, model.dies, process, X_0))
      , segments(forging_case.segments)
      , objectives(parameters.make_objectives(model.dies, *billet))
  {
    earlier.apply(process);
    set_numerics(segments.front().parameters, model);
  }

  ForgingProblem::ForgingProblem(Parameters       resolved,
                                 TetMesh          mesh,
                                 std::vector<Die> dies,
                                 Process<double>  at_process,
                                 Objectives       given)
      : parameters(std::move(resolved))
      , billet(std::make_shared<const TetMesh>(std::move(mesh)))
      , nominal_billet(billet)
      , X_0(billet->X)
      , model{parameters.discretization.choice, std::move(dies), {}, {}, {}, MPI_COMM_WORLD}
      , process(std::move(at_process))
      , segments(1)
      , objectives(given.empty() ? parameters.make_objectives(model.dies, *billet) : std::move(given))
  {
    segments.front().parameters = parameters;
    set_numerics(parameters, model);
  }

  void ForgingProblem::repeat_steps(const std::vector<double> &strokes)
  {
    for (NumericsSegment &segment : segments)
      segment.parameters.press.steps = {strokes, 1.};
  }

  namespace
  {
    // Growth is told in as many parts: rounding of positions must not change what is wanted.
    constexpr double parts_of_growth = 1e9;

    /// Returns the wanted length of the edges [mm]. A design is forged on the first mesh of the nominal one, moved
    /// to it: elements made on the way keep their proportion to those of that mesh, so that designs are compared
    /// with as many elements, and new meshes that follow the shape in derivatives grow as those of runs that decide
    /// anew.
    double edge_length(const ForgingProblem &problem, const std::size_t segment)
    {
      const TetMesh &billet = *problem.billet;
      const double   growth = std::cbrt(volume(billet.cells, problem.X_0) / volume(billet.cells, billet.X));
      return problem.segments[segment].parameters.edge_length(*problem.nominal_billet) *
             (std::round(parts_of_growth * growth) / parts_of_growth);
    }
  } // namespace

  ForwardRun::SegmentRun::SegmentRun(const ForgingProblem &problem,
                                     const std::size_t     segment,
                                     Timings              &timings)
      : press(problem.segments[segment].parameters.press)
      , remesher(problem.segments[segment].parameters.remeshing,
                 edge_length(problem, segment),
                 problem.model.dies,
                 problem.billet->patches,
                 problem.model.comm)
      , forging(problem.model, press, end_of(problem, segment), remesher, timings)
  {
  }

  namespace
  {
    std::size_t bytes_to(const ForwardRun::Keep keep)
    {
      switch (keep)
      {
        case ForwardRun::Keep::increments:
          return std::numeric_limits<std::size_t>::max();
        case ForwardRun::Keep::few:
          return ForwardRun::few_bytes;
        default:
          return 0;
      }
    }
  } // namespace

  ForwardRun::ForwardRun(ForgingProblem     problem,
                         const Keep         keep,
                         Timings           &timings,
                         const std::string &directory)
      : problem_(std::move(problem))
      , timings_(timings)
      , first_epoch_(std::make_shared<MeshEpoch>(*problem_.billet, problem_.model, timings_))
      , trace_(problem_.objectives, problem_.process)
      , can_go_back_(keep == Keep::increments || !directory.empty())
      , recording_(directory, bytes_to(keep))
      , state_(Forging::start(first_epoch_, problem_.process, problem_.X_0))
  {
    enter(0);
  }

  void ForwardRun::enter(const std::size_t segment)
  {
    segment_ = segment;
    running_ = std::make_unique<SegmentRun>(problem_, segment, timings_);
  }

  std::vector<std::string> ForwardRun::check() const
  {
    std::vector<std::string> warnings = problem_.earlier.remarks;
    const auto found = check_scene(problem_.parameters, first_epoch_->scene, problem_.process, problem_.X_0);
    warnings.insert(warnings.end(), found.begin(), found.end());
    return warnings;
  }

  void ForwardRun::restore(const unsigned int           n,
                           const Forging::RecordAccess &record,
                           const Forging::Observer     &observer)
  {
    set_numerics(problem_.segments.back().parameters, problem_.model);
    enter(problem_.segments.size() - 1);
    running_->forging.restore(problem_.process, n, record, state_, [&](const IncrementEvent &event) {
      follow(event);
      observer(event);
    });
  }

  void ForwardRun::follow(const IncrementEvent &event)
  {
    recording_.keep(event.record);
    increments_.push_back(place(event.record));
    strokes_.push_back(problem_.process.whole_stroke(event.state.stroke, event.state.operation));
    const auto timing = timings_.scope("objectives");
    trace_.add(event);
  }

  void ForwardRun::change_numerics(const NumericsSegment &segment)
  {
    problem_.segments.push_back(segment);
    set_numerics(segment.parameters, problem_.model);
    enter(problem_.segments.size() - 1);
    Forging::change_numerics(segment.input.parameters, state_);
  }

  bool ForwardRun::follows_trend() const
  {
    const auto is_on_the_way = [](const unsigned int increment) { return increment > 0; };
    return problem_.parameters.adjoint.remeshings == AdjointParameters::Remeshings::follow &&
           std::any_of(state_.remeshed.begin(), state_.remeshed.end(), is_on_the_way);
  }

  std::vector<unsigned int> ForwardRun::remeshed_for_quality() const
  {
    const auto decided_by_quality = [this](const unsigned int increment) {
      const auto later = std::find_if(problem_.segments.begin() + 1,
                                      problem_.segments.end(),
                                      [&](const NumericsSegment &of) { return of.input.first > increment; });
      return std::prev(later)->parameters.remeshing.when == RemesherParameters::When::quality;
    };
    std::vector<unsigned int> remeshed;
    std::copy_if(
      state_.remeshed.begin(), state_.remeshed.end(), std::back_inserter(remeshed), decided_by_quality);
    return remeshed;
  }

  std::vector<FollowingRule> ForwardRun::following_rules() const
  {
    return follows_trend() ? retroforge::following_rules(increments_, remeshed_for_quality())
                           : std::vector<FollowingRule>();
  }

  std::optional<ForwardRun::LateForces> ForwardRun::late_forces() const
  {
    constexpr double least_left = 0.05; // of the stroke; measured, doc/theory/remeshing.md
    if (!follows_trend())
      return {};
    const std::vector<unsigned int> remeshed = remeshed_for_quality();
    LateForces                      late{std::vector<bool>(problem_.objectives.size(), false),
                    retroforge::following_rules(increments_, remeshed, least_left)};
    if (late.rules == retroforge::following_rules(increments_, remeshed))
      return {};
    std::vector<IncrementDecisions> increments;
    for (const StrokeStep &at : increments_)
    {
      const double begin = problem_.process.whole_stroke(at.stroke, at.operation);
      increments.push_back({begin, begin + at.step, false, 0});
    }
    for (std::size_t o = 0; o < late.objectives.size(); ++o)
      if (const auto &path = problem_.objectives[o].path; path && path->is_of_forces())
        late.objectives[o] =
          span_of(shares_of_increments(*path, trace_.recorded().rows[o]), increments).is_short();
    if (std::find(late.objectives.begin(), late.objectives.end(), true) == late.objectives.end())
      return {};
    return late;
  }

  bool ForwardRun::is_left() const
  {
    return segment_ + 1 < problem_.segments.size() || running_->forging.is_left(state_);
  }

  void ForwardRun::forge(const Forging::Observer &observer)
  {
    for (;;)
    {
      running_->forging.run(problem_.process, state_, [&](const IncrementEvent &event) {
        follow(event);
        if (observer)
          observer(event);
      });
      if (segment_ + 1 == problem_.segments.size())
        return;
      set_numerics(problem_.segments[segment_ + 1].parameters, problem_.model);
      enter(segment_ + 1);
      Forging::change_numerics({}, state_);
    }
  }

  std::vector<double> ForwardRun::values()
  {
    trace_.decide(state_);
    const std::vector<double> values = trace_.values(state_);
    for (std::size_t j = 0; j < values.size(); ++j)
      if (!std::isfinite(values[j]))
        throw Error("Objective " + problem_.objectives[j].name,
                    "its value is " + as_text(values[j]),
                    "results must be finite numbers",
                    "use values of the usual size, of exponents and sharpness in particular");
    return values;
  }

  RecordHeader ForwardRun::record_header(const std::string &parameters) const
  {
    return {
      version, commit, parameters, facets(dies()), *problem_.billet, problem_.X_0, fingerprints(dies())};
  }

  void ForwardRun::write_record(const std::string &directory, const std::string &parameters) const
  {
    make_directory(directory);
    write_file(directory + "/parameters.prm", parameters);
    RecordWriter writer(directory, record_header(parameters));
    const auto   record = recording_.access();
    for (unsigned int i = 0; i < state_.increments; ++i)
      writer.write(record(i));
    writer.finish();
  }

  RecordedForging ForwardRun::recorded() const
  {
    AssertThrow(can_go_back_, dealii::ExcMessage("a run is differentiated whose increments are kept"));
    return {problem_.model,
            first_epoch_,
            problem_.process,
            recording_.access(),
            state_.increments,
            problem_.objectives,
            trace_.recorded(),
            timings_,
            following_rules(),
            problem_.X_0,
            follows_trend()};
  }

  namespace
  {
    /// What of a combination is of objectives that are marked, or that are not.
    Combination part_of(Combination combination, const std::vector<bool> &marked, const bool which)
    {
      for (std::size_t o = 0; o < combination.weights.size(); ++o)
        if (marked[o] != which)
          combination.weights[o] = 0.;
      return combination;
    }

    bool is_nothing(const Combination &combination)
    {
      return std::all_of(
        combination.weights.begin(), combination.weights.end(), [](const double w) { return w == 0.; });
    }

    void add_result(AdjointResult &&part, std::optional<AdjointResult> &sum)
    {
      if (!sum)
      {
        sum = std::move(part);
        return;
      }
      for (std::size_t k = 0; k < sum->X_0.size(); ++k)
        sum->X_0[k] += part.X_0[k];
      add_numbers(part.process, sum->process);
    }
  } // namespace

  AdjointSweep ForwardRun::sweep(const std::vector<Combination> &combinations) const
  {
    RecordedForging run  = recorded();
    const auto      late = late_forces();
    if (!late)
      return adjoint_sweep(run, state_, combinations);
    run.late_rules = late->rules;
    std::vector<Combination> parts;
    std::vector<bool>        are_late;
    std::vector<std::size_t> of;
    for (std::size_t c = 0; c < combinations.size(); ++c)
      for (const bool is_late : {false, true})
        if (Combination part = part_of(combinations[c], late->objectives, is_late);
            !is_nothing(part) || (!is_late && is_nothing(combinations[c])))
        {
          parts.push_back(std::move(part));
          are_late.push_back(is_late);
          of.push_back(c);
        }
    AdjointSweep                              of_parts = adjoint_sweep(run, state_, parts, are_late);
    std::vector<std::optional<AdjointResult>> sums(combinations.size());
    for (std::size_t p = 0; p < parts.size(); ++p)
      add_result(std::move(of_parts.gradients[p]), sums[of[p]]);
    AdjointSweep sweep;
    sweep.linear_solves = of_parts.linear_solves;
    for (std::optional<AdjointResult> &sum : sums)
      sweep.gradients.push_back(std::move(*sum));
    return sweep;
  }

  namespace
  {
    template <typename T>
    void take_marked(const std::vector<T> &from, const std::vector<bool> &marked, std::vector<T> &to)
    {
      for (std::size_t o = 0; o < to.size(); ++o)
        if (marked[o])
          to[o] = from[o];
    }
  } // namespace

  std::vector<Dual> ForwardRun::tangent(const Process<Dual> &process, NodalVectors<Dual> X_0) const
  {
    RecordedForging run  = recorded();
    const auto      late = late_forces();
    if (!late)
      return tangent_sweep(run, begun(process), std::move(X_0));
    std::vector<Dual> values = tangent_sweep(run, begun(process), X_0);
    run.rules                = late->rules;
    take_marked(tangent_sweep(run, begun(process), std::move(X_0)), late->objectives, values);
    return values;
  }

  ForgingState ForwardRun::replay(const Process<double>            &at_process,
                                  const NodalVectors<double>       &X_0,
                                  const std::vector<FollowingRule> &rules,
                                  const Forging::Observer          &observer) const
  {
    const Process<double>           process = begun(at_process);
    ForgingState                    state   = Forging::start(first_epoch_, process, X_0);
    std::optional<Forging::Nominal> nominal;
    if (follows_trend())
      nominal.emplace(Forging::Nominal{problem_.process, problem_.X_0, rules});
    running_->forging.replay(
      process, nominal ? &*nominal : nullptr, state_.increments, recorded().record, state, observer);
    return state;
  }

  ForgingState ForwardRun::replay(const Process<double>      &process,
                                  const NodalVectors<double> &X_0,
                                  const Forging::Observer    &observer) const
  {
    return replay(process, X_0, following_rules(), observer);
  }

  std::vector<double> ForwardRun::replayed_values(const Process<double>            &process,
                                                  const NodalVectors<double>       &X_0,
                                                  const std::vector<FollowingRule> &rules) const
  {
    const Process<double> begins = begun(process); // the trace refers to it
    ObjectiveTrace        trace(problem_.objectives, begins, trace_.recorded().decisions);
    const ForgingState    state =
      replay(process, X_0, rules, [&](const IncrementEvent &event) { trace.add(event); });
    return trace.values(state);
  }

  std::vector<double> ForwardRun::replayed_values(const Process<double>      &process,
                                                  const NodalVectors<double> &X_0) const
  {
    std::vector<double> values = replayed_values(process, X_0, following_rules());
    if (const auto late = late_forces())
      take_marked(replayed_values(process, X_0, late->rules), late->objectives, values);
    return values;
  }
} // namespace retroforge
