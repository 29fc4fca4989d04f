// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/error_indicator.h>
#include <retroforge/linear_algebra/direct_solver.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/mesh/self_crossing.h>
#include <retroforge/steps/change_of_mesh.h>
#include <retroforge/time/forging.h>

#include <algorithm>

namespace retroforge
{
  /// Increments between looks at whether the surface of a mesh that is not remade crosses itself.
  constexpr unsigned int fold_interval = 5;

  /// Of a step for accuracy: where metal flows that fast, a part of it that does not matter does.
  constexpr unsigned int most_halvings = 6;

  /// The last increment of an operation is about this part of what its strain would let it be.
  constexpr double shortest_at_end = 12.;

  Forging::Forging(const ForgingModel    &model,
                   const PressParameters &press,
                   const StrokeStep      &end,
                   const Remesher        &remesher,
                   Timings               &timings)
      : model_(model)
      , steps_(press.steps)
      , end_(end)
      , remesher_(remesher)
      , timings_(timings)
      , limits_(model, press, remesher)
  {
  }

  ForgingState Forging::start(std::shared_ptr<MeshEpoch>  epoch,
                              const Process<double>      &process,
                              const NodalVectors<double> &X_0)
  {
    Assert(epoch != nullptr, dealii::ExcMessage("a run starts on a mesh"));
    AssertDimension(X_0.size(), epoch->scene.mesh.n_nodes());
    ForgingState state;
    state.workpiece = workpiece_before(process, X_0, epoch->scene.mesh.n_cells());
    state.volume    = volume(epoch->scene.mesh.cells, X_0);
    state.next.W    = Field<double>(epoch->scene.discretization);
    state.epoch     = std::move(epoch);
    return state;
  }

  namespace
  {
    /// Mean of the strains of an increment over the metal, weighted with themselves: that of the metal that
    /// flows.
    double mean_flow_strain(const TetMesh                   &mesh,
                            const WorkpieceState<3, double> &after,
                            const CellField<double>         &strain_before)
    {
      double sum = 0., of_squares = 0.;
      for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      {
        const double weighted =
          (after.strain[c] - strain_before[c]) * cell_geometry(corners(mesh.cells[c], after.X)).volume;
        sum += weighted;
        of_squares += (after.strain[c] - strain_before[c]) * weighted;
      }
      return sum > 0. ? of_squares / sum : 0.;
    }
  } // namespace

  std::optional<StepRejection> Forging::attempt(const Process<double> &process,
                                                const ForgingState    &state,
                                                InitialGuess          &guess,
                                                IncrementRecord       &record,
                                                SolvedIncrement       &solved) const
  {
    try
    {
      solved = state.epoch->increment.forward(process, state.workpiece, false, guess, record);
    }
    catch (const NoEquilibrium &failure)
    {
      return StepRejection{failure.what()};
    }
    catch (const NoLinearSolution &)
    {
      return IncrementLimits::singular(state);
    }
    guess.W.V.take(record.solves.front().V);
    guess.W.P.take(record.solves.front().P);
    guess.origin      = Origin::previous;
    guess.ahead       = 0.;
    const auto timing = timings_.scope("checks");
    return limits_.rejection(process, *state.epoch, record, state.workpiece.X, solved.X);
  }

  namespace
  {
    bool crosses(const ForgingState &state)
    {
      return !self_crossings(state.epoch->scene.mesh, state.workpiece.X).empty();
    }
  } // namespace

  void Forging::change_mesh(const std::vector<DieState<double>> &dies,
                            const RemeshRecord                  &remesh,
                            ForgingState                        &state,
                            const FollowingMesh                 *following) const
  {
    state.removed_volume += remesh.removed_volume;
    const TransferOperator          &J           = remesh.transfer;
    const std::shared_ptr<MeshEpoch> before      = state.epoch; // fields know its nodes
    const auto                       transferred = [&](const Field<double> &W) {
      if (W.empty())
        return W;
      const auto          &old = before->scene.discretization;
      NodalVectors<double> V   = W.V.complete(*old.condensed_nodes());
      V.resize(old.n_vertices());
      return interpolated(
        state.epoch->scene.discretization, J.apply(V), J.apply(W.P.complete(*old.pressure_nodes())));
    };
    auto workpiece =
      retroforge::change_mesh(before->scene.mesh, remesh, state.workpiece, model_.dies, dies, following);
    state.left_behind.push_back(without_motion(std::exchange(state.workpiece, std::move(workpiece))));
    state.epoch  = std::make_shared<MeshEpoch>(remesh.mesh, model_, timings_);
    state.next.W = transferred(state.next.W);
    if (state.next.rate)
      state.next.rate = transferred(*state.next.rate);
    // Fields on the new mesh are shown, and measured, where an increment fails that began with it.
    const auto &discretization = state.epoch->scene.discretization;
    state.solution             = LastSolution{state.next.W.V.complete(*discretization.condensed_nodes()),
                                  state.next.W.P.complete(*discretization.pressure_nodes())};
    state.next.origin          = Origin::transferred;
    state.remeshed.push_back(state.increments);
  }

  std::optional<OptimalSizes> Forging::error_sizes(const Process<double> &process,
                                                   const ForgingState    &state) const
  {
    if (!remesher_.follows_errors() || !state.solution || state.increments == 0)
      return {};
    const auto    timing = timings_.scope("error sizes");
    const Scene  &scene  = state.epoch->scene;
    Field<double> W(scene.discretization);
    W.V.take(state.solution->V);
    W.P.take(state.solution->P);
    return optimal_sizes(
      scene.mesh,
      state.workpiece.X,
      indicated_errors(scene.discretization,
                       state.workpiece.X,
                       W,
                       process.material,
                       point_states(scene.mesh, process.material.initial, state.workpiece)),
      velocity_degree(scene.discretization),
      remesher_.error_size_bounds());
  }

  void Forging::remesh(const Process<double> &process, ForgingState &state, IncrementRecord &record) const
  {
    const auto   timing     = timings_.scope("remeshing");
    const double repairable = remesher_.largest_repair() * state.volume - state.removed_volume;
    const auto   dies       = process.at_stroke(state.stroke, state.operation).dies;
    record.remesh           = remesher_.remesh(
      state.epoch->scene.mesh, state.workpiece.X, dies, error_sizes(process, state), repairable, timings_);
    change_mesh(dies, *record.remesh, state);
  }

  void Forging::finish_increment(const Process<double>   &process,
                                 const IncrementRecord   &record,
                                 const SolvedIncrement   &solved,
                                 ForgingState            &state,
                                 const Observer          &observer,
                                 const MovedEnds<double> &ends) const
  {
    const NodalVectors<double> X_before      = state.workpiece.X;
    const CellField<double>    strain_before = state.workpiece.strain;
    {
      const auto timing = timings_.scope("checks");
      auto       memory = state.epoch->increment.advance(process, solved, record, state.workpiece);
      if (Increment::reads_history(process))
        state.remembered.push_back(std::move(memory));
    }
    state.next                 = state.epoch->increment.mechanics.guess_after(solved, record);
    const auto &discretization = state.epoch->scene.discretization;
    state.solution             = LastSolution{solved.last().W.V.complete(*discretization.condensed_nodes()),
                                  solved.last().W.P.complete(*discretization.pressure_nodes())};
    state.slip                 = limits_.slip(process, record, X_before, state.workpiece.X) / record.step;
    state.strain_rate =
      mean_flow_strain(state.epoch->scene.mesh, state.workpiece, strain_before) / record.step;
    state.stroke += record.step;
    state.energy.deformation += record.deformation_energy;
    state.energy.friction += record.friction_energy;
    state.energy.closing += record.closing_energy;
    state.cuts += record.cuts;
    state.newton += record.newton;
    state.krylov += record.krylov;
    state.linear_solves += record.linear_solves;
    ++state.increments;
    choose_depth(record.step, last_stroke(process, state) - state.stroke, state);
    if (observer)
      observer({record, X_before, solved, state, process.whole_time(state.stroke, state.operation), ends});
  }

  std::optional<StepRejection> Forging::too_strained(const Process<double> &process,
                                                     const ForgingState    &state,
                                                     const SolvedIncrement &solved,
                                                     const IncrementRecord &record) const
  {
    if (state.strain_rate > 0. || !limits_.choose_steps())
      return {};
    const auto timing = timings_.scope("checks");
    auto       after  = state.workpiece;
    state.epoch->increment.advance(process, solved, record, after);
    return limits_.strain_rejection(mean_flow_strain(state.epoch->scene.mesh, after, state.workpiece.strain));
  }

  void Forging::choose_depth(const double last_step, const double left, ForgingState &state) const
  {
    constexpr unsigned int deepest = 30;
    const double           whole = nominal_step(), done = (state.stroke - state.numerics_stroke) / whole;
    const auto             step = [&](const unsigned int depth) { return std::ldexp(whole, -int(depth)); };
    if (!steps_.empty()) // it counts within a step that is not kept whole: as long as the last one, or longer
      for (state.depth = 0; step(state.depth + 1) > last_step * (1. - 1e-9) && state.depth < deepest;)
        ++state.depth;
    while (steps_.empty() && step(state.depth) > last_step * (1. + 1e-9) && state.depth < deepest)
      ++state.depth;
    while (!limits_.allow_strain(state.strain_rate * step(state.depth)) && state.depth < most_halvings)
      ++state.depth;
    if (!steps_.empty())
      return;
    // Back to longer steps once a whole number of them fits, and nothing slips or is strained too far in them.
    const auto bears = [&](const unsigned int depth) {
      const double number = std::ldexp(done, depth);
      return limits_.allow(state.slip * step(depth)) &&
             limits_.allow_strain(state.strain_rate * step(depth)) &&
             std::abs(number - std::round(number)) < 1e-9;
    };
    while (state.depth > 0 && bears(state.depth - 1))
      --state.depth;
    // A force is that of the middle of an increment, and what a press must bring up is that of the end.
    const double least = limits_.borne_step(state.strain_rate) / shortest_at_end;
    while (left > 0. && step(state.depth) > 0.5 * left * (1. + 1e-9) && step(state.depth + 1) > least)
      ++state.depth;
  }

  double
  Forging::next_step(const Process<double> &process, const ForgingState &state, unsigned int &cuts) const
  {
    cuts = 0;
    return told_by_strokes(state.stroke,
                           steps_.empty() ? std::min(nominal_step() / (1 << state.depth),
                                                     last_stroke(process, state) - state.stroke)
                                          : repeated_step(process, state, cuts));
  }

  double
  Forging::repeated_step(const Process<double> &process, const ForgingState &state, unsigned int &cuts) const
  {
    const double rounding = 1e-9 * nominal_step(), at = process.whole_stroke(state.stroke, state.operation);
    const auto   end   = std::upper_bound(steps_.ends.begin(), steps_.ends.end(), at + rounding);
    const double begin = end == steps_.ends.begin() ? 0. : *std::prev(end);
    const double left  = last_stroke(process, state) - state.stroke;
    double       step  = end == steps_.ends.end() ? left : std::min(*end - at, left);
    // The rest of one that was not kept whole, in parts as long as the last increment.
    if (at > begin + rounding)
      return step / std::max(1., std::ceil(std::ldexp(step / nominal_step(), state.depth) - 1e-9));
    for (; !limits_.bear(state, step) && cuts < most_halvings; ++cuts)
      step *= 0.5;
    return step;
  }

  void Forging::change_numerics(std::optional<std::string> parameters, ForgingState &state)
  {
    state.depth               = 0;
    state.numerics_stroke     = state.stroke;
    state.numerics_increments = state.increments;
    state.parameters          = std::move(parameters);
  }

  void Forging::enter(const unsigned int operation, ForgingState &state) const
  {
    if (operation == state.operation)
      return;
    state.operation = operation;
    state.stroke    = 0.;
    change_numerics(state.parameters, state);
    state.workpiece.velocity.clear();
    state.next   = {};
    state.next.W = Field<double>(state.epoch->scene.discretization);
  }

  double Forging::last_stroke(const Process<double> &process, const ForgingState &state) const
  {
    AssertIndexRange(state.operation, process.operations.size());
    return state.operation == end_.operation ? end_.stroke : process.operations[state.operation].stroke;
  }

  bool Forging::is_left(const ForgingState &state) const
  {
    return state.operation < end_.operation || state.stroke < end_.stroke - 1e-9 * nominal_step();
  }

  void Forging::run(const Process<double> &process, ForgingState &state, const Observer &observer) const
  {
    std::vector<bool> frozen;
    if (remesher_.enabled())
      frozen = remesher_.frozen(state.epoch->scene.mesh);
    const auto since_remeshing = [&]() {
      return state.increments - (state.remeshed.empty() ? 0 : state.remeshed.back());
    };
    // Also where a run is resumed that stopped for that.
    if (!remesher_.enabled())
      limits_.check_fold(state);
    if (state.increments > 0)
      limits_.check_progress(state);
    while (is_left(state))
    {
      if (!(state.stroke < last_stroke(process, state) - 1e-9 * nominal_step()))
      {
        enter(state.operation + 1, state);
        continue; // other numerics may begin here
      }
      IncrementRecord record;
      const auto      renew = [&]() {
        remesh(process, state, record);
        frozen = remesher_.frozen(state.epoch->scene.mesh);
      };
      const auto ask_for_other_sizes = [&](const std::optional<OptimalSizes> &errors) {
        return errors && Remesher::worthwhile(*errors, since_remeshing(), state.increments == 1);
      };
      const bool crossed = remesher_.enabled() && crosses(state);
      if (crossed && state.removed_volume >= remesher_.largest_repair() * state.volume)
        limits_.check_fold(state);
      if (crossed ||
          (remesher_.enabled() && (remesher_.due(state.epoch->scene.mesh,
                                                 state.workpiece.X,
                                                 process.at_stroke(state.stroke, state.operation).dies,
                                                 frozen,
                                                 since_remeshing(),
                                                 state.increments == 0) ||
                                   ask_for_other_sizes(error_sizes(process, state)))))
        renew();
      if (crossed)
        limits_.check_fold(state);
      record.operation = state.operation;
      record.stroke    = state.stroke;
      record.step      = next_step(process, state, record.cuts);
      record.contact =
        limits_.choose_steps() ? model_.step.contact.in_steps_of(record.step) : model_.step.contact;
      record.parameters = std::exchange(state.parameters, std::nullopt);
      SolvedIncrement solved;
      InitialGuess    guess   = state.next;
      bool            is_full = false;
      for (;;)
      {
        auto rejection = attempt(process, state, guess, record, solved);
        if (is_good(rejection))
          if (const auto strained = too_strained(process, state, solved, record))
            rejection = strained;
        const bool remeshes =
          rejection && rejection->of_mesh && remesher_.enabled() && !record.remesh && since_remeshing() > 0;
        if (is_good(rejection) && !remeshes)
          break;
        is_full = rejection->is_full |= is_full;
        if (remeshes)
        {
          renew();
          guess = state.next;
          continue;
        }
        record.step =
          told_by_strokes(record.stroke, std::ldexp(record.step, -static_cast<int>(rejection->halvings)));
        record.cuts += rejection->halvings;
        if (rejection->for_accuracy)
          record.contact = model_.step.contact.in_steps_of(record.step);
        if (limits_.too_short(record.step))
        {
          // A fold that is closing is the true reason.
          limits_.check_fold(state);
          limits_.stop(process, state, record, *rejection);
        }
      }
      limits_.check_hold(process, state, record);
      finish_increment(process, record, solved, state, observer);
      limits_.check_progress(state);
      // With remeshing, the next increment begins with a repair.
      const bool last = !is_left(state);
      if (remesher_.enabled()
            ? last && !remesher_.repairs(state.epoch->scene.mesh,
                                         state.workpiece.X,
                                         process.at_stroke(state.stroke, state.operation).dies)
            : last || state.increments % fold_interval == 0)
        limits_.check_fold(state);
    }
  }

  void Forging::restore(const Process<double> &process,
                        const unsigned int     n,
                        const RecordAccess    &access,
                        ForgingState          &state,
                        const Observer        &observer) const
  {
    for (unsigned int i = 0; i < n; ++i)
    {
      const IncrementRecord &record = access(i);
      enter(record.operation, state);
      if (record.parameters)
        change_numerics({}, state);
      if (record.remesh)
        change_mesh(process.at_stroke(state.stroke, state.operation).dies, *record.remesh, state);
      finish_increment(
        process, record, state.epoch->increment.recorded(process, state.workpiece, record), state, observer);
    }
  }

  void Forging::replay(const Process<double> &process,
                       const Nominal         *nominal,
                       const unsigned int     n,
                       const RecordAccess    &access,
                       ForgingState          &state,
                       const Observer        &observer) const
  {
    MovedEnds<double>    ends;
    NodalVectors<double> X_nominal, X_made_nominal, X_made = state.workpiece.X;
    if (nominal != nullptr)
      X_made_nominal = X_nominal = nominal->X_0;
    for (unsigned int i = 0; i < n; ++i)
    {
      IncrementRecord record = access(i);
      record.newton = record.krylov = record.linear_solves = 0;
      enter(record.operation, state);
      if (record.remesh)
      {
        const StrokeStep at{record.stroke, 0., record.operation};
        const auto       following = following_mesh(nominal != nullptr, i, *record.remesh);
        change_mesh(with_moved_ends(process, at, {ends.end, ends.end}).over(at).dies,
                    *record.remesh,
                    state,
                    following.get());
        X_made_nominal = X_nominal = record.remesh->mesh.X;
        X_made                     = state.workpiece.X;
      }
      Mechanics &mechanics = state.epoch->increment.mechanics;
      ends                 = {ends.end, 0.};
      if (nominal != nullptr && !nominal->rules.empty())
      {
        const NodalVectors<double> V = mechanics.mean_velocity(record);
        ends.end                     = FollowingEnd(state.epoch->scene.mesh,
                                X_made_nominal,
                                X_nominal,
                                V,
                                nominal->process,
                                place(record),
                                nominal->rules[i])
                     .moved(ends.start, X_made, state.workpiece.X);
        const double dt = nominal->process.duration(place(record));
        for (std::size_t k = 0; k < X_nominal.size(); ++k)
          X_nominal[k] += dt * V[k];
      }
      const Process<double> moved = with_moved_ends(process, place(record), ends);
      const InitialGuess    guess = mechanics.recorded_guess(record);
      const SolvedIncrement solved =
        state.epoch->increment.forward(moved, state.workpiece, true, guess, record);
      finish_increment(moved, record, solved, state, observer, ends);
    }
  }
} // namespace retroforge
