// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/adjoint/sweep.h>
#include <retroforge/steps/change_of_mesh.h>
#include <retroforge/steps/moved_ends.h>

#include <algorithm>
#include <array>
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

    /// The costates of all combinations, on their way from the end of a run to its beginning.
    class WayBack
    {
    public:
      WayBack(const RecordedForging          &run,
              const ForgingState             &end,
              const std::vector<Combination> &combinations,
              const std::vector<bool>        &late)
          : run_(run)
          , end_(end)
          , combinations_(combinations)
          , late_(late.empty() ? std::vector<bool>(combinations.size(), false) : late)
          , costates_(start_costates(run, end, combinations))
          , state_(end.workpiece)
          , remeshed_(end.remeshed)
          , epoch_(end.epoch)
          , rows_bar_(run.objectives.size())
          , end_bar_(combinations.size(), 0.)
          , made_bar_(combinations.size(), NodalVectors<double>(end.workpiece.X.size()))
      {
        for (std::size_t o = 0; o < run.objectives.size(); ++o)
          if (run.objectives[o].path)
          {
            AssertDimension(run.traced.rows[o].size(), end.increments);
            rows_bar_[o] = run.objectives[o].path->reverse_value(run.traced.rows[o]);
          }
        epoch_->increment.mechanics.forget();
      }

      /// From the end of an increment to that of the one before, on the mesh of that.
      void over(unsigned int i);

      /// From the start of the run to the initial state.
      AdjointSweep arrive();

    private:
      /// An increment, and how the one before moved, on the mesh of the increment.
      struct Step
      {
        unsigned int         i;
        IncrementRecord      record;
        NodalVectors<double> velocity_before; ///< none where it begins at rest
        bool                 goes_on;         ///< with the operation of the one before
      };

      Step step(unsigned int i) const;
      void restore_start(const Step &step);
      void reverse_increment(const Step &step);
      void reverse_ends(const Step                                       &step,
                        const std::array<std::optional<FollowingEnd>, 2> &following,
                        std::vector<Costate>                             &parts);
      void leave_mesh_as_made(const Step &step);
      void reverse_remeshing(const Step &step);

      bool ends_follow() const { return !run_.rules.empty(); }

      FollowingRule rule_of(const bool late, const unsigned int i) const
      {
        const std::vector<FollowingRule> &rules = late ? run_.late_rules : run_.rules;
        return rules.empty() ? FollowingRule() : rules[i];
      }

      const RecordedForging          &run_;
      const ForgingState             &end_;
      const std::vector<Combination> &combinations_;
      const std::vector<bool>         late_; ///< which of them have the late rules

      std::vector<Costate>       costates_;
      WorkpieceState<3, double>  state_;    ///< at the end, then at the start of each increment
      std::vector<unsigned int>  remeshed_; ///< increments before that began on a new mesh
      std::shared_ptr<MeshEpoch> epoch_;

      std::vector<PathRows<double>> rows_bar_; ///< of each objective

      /// Derivatives in how far the end of the increment at hand moves; 0 where it does not.
      std::vector<double> end_bar_;
      /// In the positions at which the mesh at hand was made.
      std::vector<NodalVectors<double>> made_bar_;

      /// At the starts of the increments that are left on the mesh at hand.
      std::vector<NodalVectors<double>> starts_;

      unsigned int linear_solves_ = 0;
    };

    WayBack::Step WayBack::step(const unsigned int i) const
    {
      // Of a recording on the disk the next increment that is read takes the place of this one.
      NodalVectors<double> velocity;
      unsigned int         operation = 0;
      if (i > 0)
      {
        const IncrementRecord &earlier = run_.record(i - 1);
        velocity                       = epoch_->increment.mechanics.mean_velocity(earlier);
        operation                      = earlier.operation;
      }
      Step step{i, run_.record(i), {}, false};
      // An operation begins at rest.
      if (step.record.operation == operation)
      {
        step.velocity_before = std::move(velocity);
        step.goes_on         = i > 0;
      }
      return step;
    }

    void WayBack::over(const unsigned int i)
    {
      const Step step = this->step(i);
      restore_start(step);
      reverse_increment(step);
      if (step.record.remesh || i == 0)
        leave_mesh_as_made(step);
      if (step.record.remesh)
        reverse_remeshing(step);
    }

    void WayBack::restore_start(const Step &step)
    {
      if (starts_.empty())
        starts_ = positions_of(run_, *epoch_, remeshed_.empty() ? 0 : remeshed_.back(), step.i + 1);
      if (!end_.remembered.empty())
        state_ = end_.remembered[step.i].start.get();
      state_.X = std::move(starts_.back());
      starts_.pop_back();
      state_.velocity = step.velocity_before;
      if (step.record.remesh && !step.velocity_before.empty())
        state_.velocity = step.record.remesh->transfer.apply<Vec3>(step.velocity_before);
    }

    void WayBack::reverse_increment(const Step &step)
    {
      const unsigned int                         before = epoch_->system.n_solves;
      std::vector<Costate>                       parts;
      std::array<std::optional<FollowingEnd>, 2> following; // and late
      if (ends_follow())
      {
        parts = apart(run_, costates_);
        for (const bool late : {false, true})
          if (std::find(late_.begin(), late_.end(), late) != late_.end())
            following[late].emplace(epoch_->scene.mesh,
                                    remeshed_.empty() ? run_.X_0 : epoch_->scene.mesh.X,
                                    state_.X,
                                    epoch_->increment.mechanics.mean_velocity(step.record),
                                    run_.process,
                                    place(step.record),
                                    rule_of(late, step.i));
      }
      const IncrementMemory no_history;
      epoch_->increment.reverse(run_.process,
                                state_,
                                end_.remembered.empty() ? no_history : end_.remembered[step.i],
                                step.record,
                                source_of(run_, rows_bar_, combinations_, step.i),
                                ends_follow() ? parts : costates_);
      if (ends_follow())
        reverse_ends(step, following, parts);
      else
        for (std::size_t j = 0; j < costates_.size(); ++j)
          reverse_rows(run_, rows_bar_, combinations_[j], step.i, step.record, costates_[j]);
      linear_solves_ += epoch_->system.n_solves - before;
    }

    /// What fell on the ends of the increment falls on the state at its start, and on the end of the one before.
    void WayBack::reverse_ends(const Step                                       &step,
                               const std::array<std::optional<FollowingEnd>, 2> &following,
                               std::vector<Costate>                             &parts)
    {
      for (std::size_t j = 0; j < costates_.size(); ++j)
      {
        const MovedEnds<double> of_rows =
          reverse_rows(run_, rows_bar_, combinations_[j], step.i, step.record, costates_[j]);
        const MovedEnds<double> of_work  = together(run_, step.record, std::move(parts[j]), costates_[j]);
        const double            of_start = following[late_[j]]->reverse_moved(
          end_bar_[j] + of_rows.end + of_work.end, made_bar_[j], costates_[j].workpiece.X);
        end_bar_[j] = step.goes_on ? of_start + of_rows.start + of_work.start : 0.;
      }
    }

    /// At the first increment of a mesh the positions it was made at are those at hand.
    void WayBack::leave_mesh_as_made(const Step &step)
    {
      if (!ends_follow())
        return;
      for (std::size_t j = 0; j < costates_.size(); ++j)
      {
        for (std::size_t k = 0; k < made_bar_[j].size(); ++k)
          costates_[j].workpiece.X[k] += made_bar_[j][k];
        made_bar_[j].assign(step.record.remesh ? step.record.remesh->X_before.size() : 0, Vec3());
      }
    }

    void WayBack::reverse_remeshing(const Step &step)
    {
      const auto remesh = step.record.remesh;
      remeshed_.pop_back();
      epoch_ =
        remeshed_.empty()
          ? run_.first
          : std::make_shared<MeshEpoch>(run_.record(remeshed_.back()).remesh->mesh, run_.model, run_.timings);
      epoch_->increment.mechanics.forget();
      state_          = end_.left_behind[remeshed_.size()];
      state_.X        = remesh->X_before;
      state_.velocity = step.velocity_before;
      const StrokeStep at{step.record.stroke, 0., step.record.operation};
      const auto       dies = run_.process.over(at).dies;
      MovingTransfer   moving(epoch_->scene.mesh, remesh->X_before, remesh->mesh, remesh->transfer);
      const auto       following = following_mesh(run_.meshes_follow, step.i, *remesh);
      for (std::size_t j = 0; j < costates_.size(); ++j)
      {
        PhysicsBar bar(run_.model.dies);
        costates_[j].workpiece = reverse_change_mesh(epoch_->scene.mesh,
                                                     *remesh,
                                                     state_,
                                                     run_.model.dies,
                                                     dies,
                                                     costates_[j].workpiece,
                                                     moving,
                                                     bar.dies,
                                                     following.get());
        costates_[j].process.add_once(
          [&](Process<double> &part) { reverse_over(run_.process, at, 0., bar, part); });
        if (!ends_follow() || !step.goes_on)
          continue;
        Process<double> process_bar = no_process_derivatives(run_.process, run_.model.dies);
        reverse_over(run_.process, at, 0., bar, process_bar);
        end_bar_[j] += reverse_moved_ends(run_.process, at, process_bar).start;
      }
    }

    AdjointSweep WayBack::arrive()
    {
      AdjointSweep sweep;
      sweep.linear_solves = linear_solves_;
      for (Costate &costate : costates_)
      {
        const auto  &T_bar = costate.workpiece.temperature;
        const double sum   = std::accumulate(T_bar.begin(), T_bar.end(), 0.);
        costate.process.add_once([&](Process<double> &part) { part.material.initial.temperature += sum; });
        sweep.gradients.push_back({std::move(costate.workpiece.X), costate.process.complete()});
      }
      return sweep;
    }
  } // namespace

  AdjointSweep adjoint_sweep(const RecordedForging          &run,
                             const ForgingState             &end,
                             const std::vector<Combination> &combinations,
                             const std::vector<bool>        &late)
  {
    AssertDimension(end.increments, run.n);
    Assert(late.empty() || late.size() == combinations.size(),
           dealii::ExcDimensionMismatch(late.size(), combinations.size()));
    AssertDimension(run.traced.rows.size(), run.objectives.size());
    AssertDimension(run.traced.decisions.size(), run.objectives.size());
    Assert(std::all_of(combinations.begin(),
                       combinations.end(),
                       [&](const Combination &of) { return of.weights.size() == run.objectives.size(); }),
           dealii::ExcMessage("a combination has a weight for each objective"));
    WayBack way(run, end, combinations, late);
    for (unsigned int i = end.increments; i-- > 0;)
      way.over(i);
    return way.arrive();
  }
} // namespace retroforge
