// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/mpi.h>

#include <retroforge/element/strain_history.h>
#include <retroforge/time/increment.h>

namespace retroforge
{
  namespace
  {
    template <typename Number>
    NodalVectors<Number>
    advanced(const NodalVectors<Number> &X, const Number &dt, const NodalVectors<Number> &V)
    {
      NodalVectors<Number> moved = X;
      for (std::size_t k = 0; k < X.size(); ++k)
        moved[k] += V[k] * dt;
      return moved;
    }

    double dot(const NodalVectors<double> &a, const NodalVectors<double> &b)
    {
      double sum = 0.;
      for (std::size_t k = 0; k < a.size(); ++k)
        sum += a[k] * b[k];
      return sum;
    }

    void sum_over_ranks(NodalVectors<double> &x, MPI_Comm comm)
    {
      MPI_Allreduce(MPI_IN_PLACE, x.data()->begin_raw(), 3 * x.size(), MPI_DOUBLE, MPI_SUM, comm);
    }

    void sum_over_ranks(Field<double> &field, MPI_Comm comm)
    {
      sum_over_ranks(field.V, comm);
      sum_over_ranks(field.beta, comm);
      MPI_Allreduce(MPI_IN_PLACE, field.P.data(), field.P.size(), MPI_DOUBLE, MPI_SUM, comm);
    }

    Vector3<Dual> make_dual(const Vec3 &value, const Vec3 &dot)
    {
      Vector3<Dual> x;
      for (unsigned int i = 0; i < 3; ++i)
      {
        x[i]                 = Dual(value[i]);
        x[i].fastAccessDx(0) = dot[i];
      }
      return x;
    }

    Vec3 dot_of(const Vector3<Dual> &x)
    {
      Vec3 d;
      for (unsigned int i = 0; i < 3; ++i)
        d[i] = x[i].dx(0);
      return d;
    }

    NodalVectors<double> values_of(const NodalVectors<Dual> &x)
    {
      NodalVectors<double> v;
      convert(x, v);
      return v;
    }

    /// A tangent is taken where the dies have the vertices they were made with.
    Physics<double> values_of(const Physics<Dual> &physics)
    {
      auto values = converted<double>(physics);
      for (auto &die : values.dies)
        die.vertices.clear();
      return values;
    }

    Field<Dual> make_dual(const Field<double> &value, const Field<double> &dot)
    {
      Field<Dual> W;
      for (std::size_t k = 0; k < value.V.size(); ++k)
      {
        W.V.push_back(make_dual(value.V[k], dot.V[k]));
        W.P.push_back(Dual(value.P[k]));
        W.P.back().fastAccessDx(0) = dot.P[k];
      }
      for (std::size_t c = 0; c < value.beta.size(); ++c)
        W.beta.push_back(make_dual(value.beta[c], dot.beta[c]));
      return W;
    }
  } // namespace

  LastStage::LastStage(const Scene                &scene,
                       const Process<double>      &process,
                       const NodalVectors<double> &X_before,
                       const IncrementRecord      &record)
      : physics_(process.at_stroke(record.stroke))
      , dt_(process.time(record.step))
      , contact_(make_contact_set(scene.mesh,
                                  scene.topology,
                                  scene.dies,
                                  physics_.dies,
                                  record.pairs,
                                  record.contact.ramp,
                                  record.contact.approach * dt_,
                                  X_before,
                                  record.contact.approach_law(record.step),
                                  record.contact.edge_stiffness))
      , X_(record.solves.size() == 1 ? X_before : advanced(X_before, 0.5 * dt_, record.solves[0].V))
      , stage(scene, physics_, contact_, X_)
  {
  }

  Increment::Increment(const Scene            &scene,
                       const StepModel        &model,
                       const NewtonParameters &newton,
                       LinearSystem           &system,
                       Timings                &timings)
      : scene_(scene), model_(model), system_(system), newton_(scene, newton, system), timings_(timings)
  {
  }

  ContactSet<double> Increment::contact_set(const Physics<double>      &physics,
                                            const NodalVectors<double> &X,
                                            const IncrementRecord      &record,
                                            const double                dt) const
  {
    const auto timing = timings_.scope("contact");
    return make_contact_set(scene_.mesh,
                            scene_.topology,
                            scene_.dies,
                            physics.dies,
                            record.pairs,
                            record.contact.ramp,
                            record.contact.approach * dt,
                            X,
                            record.contact.approach_law(record.step),
                            record.contact.edge_stiffness);
  }

  bool Increment::escaped(const Stage<double> &stage, const Field<double> &W) const
  {
    // A node that was not watched must not have run into a die.
    std::vector<std::vector<bool>> watched(scene_.dies.size(), std::vector<bool>(W.V.size(), false));
    for (const ContactPair &pair : stage.contact.pairs)
      if (pair.point.is_node())
        watched[pair.die][pair.point.nodes[0]] = true;
    for (unsigned int d = 0; d < scene_.dies.size(); ++d)
      for (NodeIndex k = 0; k < W.V.size(); ++k)
        if (!watched[d][k] && scene_.topology.is_on_surface(k))
        {
          const auto  &die     = stage.physics.dies[d];
          const Vec3   u       = W.V[k] - die.velocity;
          const double reach   = approach_distance(u.norm(), stage.contact.tau, stage.contact.approach);
          const auto   feature = scene_.dies[d].closest(stage.X[k], die.displacement, reach);
          if (!feature.found())
            continue;
          const auto projection = scene_.dies[d].project(stage.X[k], die, feature);
          if (u * projection.n > approach_speed(projection.delta, stage.contact.tau, stage.contact.approach))
            return true;
        }
    return false;
  }

  NodalVectors<double> Increment::forward(const Process<double>      &process,
                                          const NodalVectors<double> &X,
                                          const bool                  replay,
                                          IncrementRecord            &record,
                                          Field<double>              &W)
  {
    const Physics<double> physics = process.at_stroke(record.stroke);
    const double          dt      = process.time(record.step);
    const bool            two     = replay ? record.solves.size() == 2 : model_.scheme == Scheme::midpoint;
    const auto frozen = [&](const unsigned int s) { return replay ? record.solves[s].active : ActiveSet(); };
    std::vector<SolveRecord> solves(two ? 2 : 1);
    if (!replay)
      record.contact = model_.contact;
    // A run that is resumed must not differ from one that was not.
    system_.reset();
    std::size_t n_watched = 0;
    for (double reach = model_.reach;; reach *= 2.)
    {
      // A wider search that finds nothing more has found all there is.
      bool all_found = false;
      if (!replay)
      {
        const auto timing = timings_.scope("contact");
        record.pairs      = find_contact_pairs(
          scene_.topology, scene_.dies, physics.dies, X, record.contact.ramp, reach, model_.edges_touch);
        all_found = reach > model_.reach && record.pairs.size() == n_watched;
        n_watched = record.pairs.size();
      }
      const ContactSet<double> contact       = contact_set(physics, X, record, dt);
      Field<double>            trial         = W;
      NodalVectors<double>     position      = X;
      bool                     repeat        = false;
      const unsigned int       solves_before = system_.n_solves;
      for (unsigned int s = 0; s < solves.size() && !repeat; ++s)
      {
        if (s == 1)
          position = advanced(X, 0.5 * dt, trial.V);
        const Stage<double>    stage(scene_, physics, contact, position);
        const Start            start      = record.remesh && s == 0 ? Start::far : Start::near;
        const NewtonStatistics statistics = newton_.solve(stage, trial, frozen(s), start);
        record.newton += statistics.iterations;
        record.krylov += statistics.krylov;
        const ActiveSet active = replay ? frozen(s) : stage.decide_active(trial);
        repeat                 = !replay && !all_found && escaped(stage, trial);
        solves[s]              = {trial.V, trial.P, active};
        if (s + 1 == solves.size() && !repeat)
        {
          // The next increment starts from what the record holds, resumed or not.
          trial                              = recorded_field(stage, solves[s]);
          const auto [deformation, friction] = stage.power(trial, active);
          record.deformation_energy          = dt * scene_.partition.sum(deformation);
          record.friction_energy             = dt * scene_.partition.sum(friction);
          record.forces                      = die_forces(stage, trial, active);
        }
      }
      record.linear_solves += system_.n_solves - solves_before;
      if (repeat)
        continue;
      record.solves = std::move(solves);
      W             = std::move(trial);
      return advanced(X, dt, W.V);
    }
  }

  NodalVectors<double> Increment::advance(const Process<double>      &process,
                                          const NodalVectors<double> &X,
                                          const IncrementRecord      &record) const
  {
    return advanced(X, process.time(record.step), record.solves.back().V);
  }

  Field<double> Increment::last_field(const Process<double>      &process,
                                      const NodalVectors<double> &X,
                                      const IncrementRecord      &record) const
  {
    const Physics<double>      physics = process.at_stroke(record.stroke);
    const ContactSet<double>   none;
    const NodalVectors<double> position = stage_positions(process, X, record);
    return recorded_field(Stage<double>(scene_, physics, none, position), record.solves.back());
  }

  void Increment::forget()
  {
    system_.reset();
    for (auto &lambdas : earlier_lambdas_)
      lambdas.clear();
  }

  Field<double> Increment::recorded_field(const Stage<double> &stage, const SolveRecord &solve) const
  {
    Field<double> W(scene_.mesh);
    W.V = solve.V;
    W.P = solve.P;
    recover_bubbles(stage, W);
    return W;
  }

  NodalVectors<double> Increment::stage_positions(const Process<double>      &process,
                                                  const NodalVectors<double> &X,
                                                  const IncrementRecord      &record) const
  {
    return record.solves.size() == 1 ? X : advanced(X, 0.5 * process.time(record.step), record.solves[0].V);
  }

  namespace
  {
    /// A rank sums over its own cells: the others' strain has no weight there.
    std::vector<double> owned_part(const std::vector<double> &strain, const Partition &partition)
    {
      std::vector<double> part(strain.size(), 0.);
      for (CellIndex c = partition.cell_begin; c < partition.cell_end; ++c)
        part[c] = strain[c];
      return part;
    }

    /// Derivatives of one scalar that an increment collects from its stages.
    struct IncrementBar
    {
      ContactSetBar        contact;
      PhysicsBar           physics;
      NodalVectors<double> X; ///< positions of the stage reversed last
    };
  } // namespace

  void Increment::reverse(const Process<double>      &process,
                          const NodalVectors<double> &X,
                          const IncrementRecord      &record,
                          const StageSource          &source,
                          std::vector<Costate>       &costates)
  {
    const MPI_Comm            comm    = scene_.partition.comm;
    const bool                first   = dealii::Utilities::MPI::this_mpi_process(comm) == 0;
    const Physics<double>     physics = process.at_stroke(record.stroke);
    const double              dt      = process.time(record.step);
    const ContactSet<double>  contact = contact_set(physics, X, record, dt);
    std::vector<IncrementBar> bars(costates.size(),
                                   {ContactSetBar(record.pairs.size()), PhysicsBar(scene_.dies), {}});
    for (unsigned int s = record.solves.size(); s-- > 0;)
    {
      const bool                 last     = s + 1 == record.solves.size();
      const SolveRecord         &solve    = record.solves[s];
      const NodalVectors<double> position = s == 0 ? X : stage_positions(process, X, record);
      const Stage<double>        stage(scene_, physics, contact, position);
      const Field<double>        W = recorded_field(stage, solve);
      const StageView<double>    view{stage, W, solve.active};
      // X_{i+1} = X_i + dt V, and for the first of two stages  Y = X_i + dt/2 V.
      const double fraction = last ? 1. : 0.5;
      system_.assemble(stage, W, solve.active);
      earlier_lambdas_[s].resize(costates.size());
      for (std::size_t j = 0; j < costates.size(); ++j)
      {
        IncrementBar               &bar     = bars[j];
        Costate                    &costate = costates[j];
        const NodalVectors<double> &next    = last ? costate.X : bar.X;
        NodalVectors<double>        position_bar(X.size());
        Field<double>               rhs(scene_.mesh);
        if (first)
          bar.physics.dt += fraction * dot(next, W.V);
        StageBar stage_bar{rhs, position_bar, bar.contact, bar.physics, model_.shape_derivatives};
        if (last)
        {
          source(j, view, stage_bar);
          if (!costate.strain.empty())
            bar.physics.dt += reverse_accumulate_strain(
              scene_.mesh, position, W, dt, owned_part(costate.strain, scene_.partition), rhs, position_bar);
          sum_over_ranks(rhs, comm);
        }
        for (std::size_t k = 0; k < X.size(); ++k)
          rhs.V[k] += fraction * dt * next[k];
        Field<double> minus_rhs(scene_.mesh), lambda;
        minus_rhs.add(-1., rhs);
        auto &guesses = earlier_lambdas_[s][j];
        system_.solve(minus_rhs, model_.adjoint_tolerance, lambda, guesses);
        guesses.insert(guesses.begin(), lambda);
        guesses.resize(std::min<std::size_t>(guesses.size(), 3));
        reverse_residual(view, lambda, stage_bar);
        if (s == 0)
          reverse_contact_set(scene_.dies,
                              physics.dies,
                              contact,
                              record.contact.ramp,
                              X,
                              bar.contact,
                              position_bar,
                              bar.physics.dies);
        sum_over_ranks(position_bar, comm);
        for (std::size_t k = 0; k < X.size(); ++k)
          costate.X[k] += position_bar[k];
        bar.X = std::move(position_bar);
      }
    }
    for (std::size_t j = 0; j < costates.size(); ++j)
      reverse_at_stroke(
        process, {record.stroke, record.step}, record.contact.approach, bars[j].physics, costates[j].process);
  }

  Field<Dual> Increment::tangent_field(const Stage<Dual>          &stage,
                                       const NodalVectors<double> &X,
                                       const ContactSet<double>   &contact,
                                       const Physics<double>      &physics,
                                       const SolveRecord          &solve)
  {
    const Stage<double> value_stage(scene_, physics, contact, X);
    const Field<double> W     = recorded_field(value_stage, solve);
    Field<Dual>         still = make_dual(W, Field<double>(scene_.mesh));
    const Field<Dual>   R     = stage.residual(still, solve.active);
    Field<double>       minus_R_dot(scene_.mesh), W_dot;
    for (std::size_t k = 0; k < R.V.size(); ++k)
    {
      minus_R_dot.V[k] = -dot_of(R.V[k]);
      minus_R_dot.P[k] = -R.P[k].dx(0);
    }
    for (std::size_t c = 0; c < R.beta.size(); ++c)
      minus_R_dot.beta[c] = -dot_of(R.beta[c]);
    system_.assemble(value_stage, W, solve.active);
    system_.solve(minus_R_dot, model_.adjoint_tolerance, W_dot);
    return make_dual(W, W_dot);
  }

  NodalVectors<Dual> Increment::tangent(const Process<Dual>      &process,
                                        const NodalVectors<Dual> &X,
                                        const IncrementRecord    &record,
                                        const TangentWatch       &watch)
  {
    const Physics<Dual>      physics       = process.at_stroke(record.stroke);
    const Dual               dt            = process.time(record.step);
    const ContactSet<Dual>   contact       = make_contact_set(scene_.mesh,
                                                      scene_.topology,
                                                      scene_.dies,
                                                      physics.dies,
                                                      record.pairs,
                                                      record.contact.ramp,
                                                      Dual(record.contact.approach * dt),
                                                      X,
                                                      record.contact.approach_law(record.step),
                                                      record.contact.edge_stiffness);
    const Physics<double>    physics_value = values_of(physics);
    const ContactSet<double> contact_value = contact_set(physics_value, values_of(X), record, dt.val());
    NodalVectors<Dual>       position      = X;
    for (unsigned int s = 0;; ++s)
    {
      const Stage<Dual> stage(scene_, physics, contact, position);
      const Field<Dual> W =
        tangent_field(stage, values_of(position), contact_value, physics_value, record.solves[s]);
      if (s + 1 < record.solves.size())
      {
        position = advanced(X, Dual(0.5 * dt), W.V);
        continue;
      }
      watch({stage, W, record.solves[s].active}, dt);
      return advanced(X, dt, W.V);
    }
  }
} // namespace retroforge
