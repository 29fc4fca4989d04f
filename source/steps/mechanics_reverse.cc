// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/geometry/vector_algebra.h>
#include <retroforge/solver/stage_motion.h>
#include <retroforge/steps/mechanics.h>

namespace retroforge
{
  void Mechanics::forget()
  {
    system_.reset();
    earlier_lambdas_.clear();
    earlier_bubbles_.clear();
  }

  namespace
  {
    /// Of the increments after, from which an adjoint system starts: each spares more iterations than it
    /// costs.
    constexpr std::size_t n_starts = 5;

    /// Objectives whose directions further ones of the same stage take. A second one spares two iterations of thirty,
    /// about what its projections cost.
    constexpr std::size_t shared_solves = 1;

    /// Derivatives of one scalar that an increment collects from its stages.
    struct IncrementBar
    {
      RankSum<ContactSetBar>        contact;
      RankSum<PhysicsBar>           physics;
      RankSum<NodalVectors<double>> velocity; ///< of the increment before
      StageHistoryBar               history;
      /// In the positions of each stage: of those that follow the one that is reversed.
      std::vector<NodalVectors<double>> Y;
    };

    /// Where the motion of a stage leads to: a weight, and derivatives in the positions there.
    using LedTo = std::vector<std::pair<double, const NodalVectors<double> *>>;

    /// The velocity leads to X' = X + dt sum b_s V_s and to the Y_r = X + dt sum a_rs V_s that follow.
    LedTo led_to_by(const Scheme               &scheme,
                    const unsigned int          s,
                    const NodalVectors<double> &X_next_bar,
                    const IncrementBar         &bar)
    {
      LedTo led_to;
      if (scheme.b[s] != 0.)
        led_to.emplace_back(scheme.b[s], &X_next_bar);
      for (unsigned int r = s + 1; r < scheme.n_stages(); ++r)
        if (scheme.a[r][s] != 0.)
          led_to.emplace_back(scheme.a[r][s], &bar.Y[r]);
      return led_to;
    }
  } // namespace

  void Mechanics::reverse(const Process<double>           &process,
                          const WorkpieceState<3, double> &state,
                          const IncrementRecord           &record,
                          const AdjointSource             &source,
                          std::vector<Costate>            &costates)
  {
    const NodalVectors<double> &X = state.X;
    AssertDimension(X.size(), scene_.mesh.n_nodes());
    AssertDimension(record.solves.size(), scheme_of(record).n_stages());
    Assert(std::all_of(costates.begin(),
                       costates.end(),
                       [&](const Costate &costate) {
                         return costate.workpiece.X.size() == X.size() &&
                                costate.workpiece.velocity.size() == X.size() &&
                                costate.workpiece.strain.size() == scene_.mesh.n_cells();
                       }),
           dealii::ExcMessage("a costate has an entry for each node and each cell"));
    const MPI_Comm                comm   = scene_.discretization.comm();
    const Scheme                 &scheme = scheme_of(record);
    const unsigned int            n      = scheme.n_stages();
    const auto                    shared = start_of(process, state, record);
    const IncrementStart<double> &start  = *shared;
    std::vector<IncrementBar>     bars(costates.size(),
                                   {{ContactSetBar(record.pairs.size()), comm},
                                        {PhysicsBar(scene_.dies), comm},
                                        {NodalVectors<double>(X.size()), comm},
                                        {},
                                        std::vector<NodalVectors<double>>(n)});
    earlier_lambdas_.resize(n);
    earlier_bubbles_.resize(n);
    std::vector<std::shared_ptr<const SolvedStage>> stages;
    for (unsigned int s = 0; s < n; ++s)
    {
      stages.push_back(recorded_stage(start, X, scheme, record.solves, s, earlier_bubbles_[s]));
      earlier_bubbles_[s] = stages[s]->W.V;
      if (s + 1 < n)
        shared->history.add(scheme, s, stages[s]->view(), start.dt);
    }
    // The first stage of a midpoint step, which leads to half a step, has a right-hand side, and a share in
    // the gradient, smaller than the second by far: what is asked of both is alike in absolute terms.
    std::vector<SharedTolerance> tolerances(costates.size(), {model_.adjoint_tolerance});
    for (unsigned int s = n; s-- > 0;)
    {
      const auto                   &at   = stages[s];
      const EquilibriumView<double> view = at->view();
      system_.assemble(at->stage, at->W, at->active);
      earlier_lambdas_[s].resize(costates.size());
      KrylovSpace shared(
        std::min<std::size_t>(costates.size() - 1, shared_solves)); // the last one's serves none
      for (std::size_t j = 0; j < costates.size(); ++j)
      {
        IncrementBar                 &bar     = bars[j];
        PhysicsBar                   &physics = bar.physics.part();
        RankSum<NodalVectors<double>> position_bar(NodalVectors<double>(X.size()), comm);
        Field<double>                 rhs(scene_.discretization);
        EquilibriumBar                stage_bar{
          rhs, position_bar.part(), bar.contact.part(), physics, model_.shape_derivatives};
        const auto led_to = led_to_by(scheme, s, costates[j].workpiece.X, bar);
        bar.physics.add_once([&](PhysicsBar &part) {
          for (const auto &[weight, there] : led_to)
            part.dt += weight * dot(*there, record.solves[s].motion());
        });
        if (scheme.b[s] != 0.)
          source(j, view, stage_bar);
        const bool leaves_history = bar.history.reverse_add(scheme, s, view, start.dt, stage_bar);
        if (scheme.b[s] != 0. || leaves_history)
          rhs.sum_ghosts();
        NodalVectors<double> motion_bar(X.size());
        for (const auto &[weight, there] : led_to)
          for (std::size_t k = 0; k < X.size(); ++k)
            motion_bar[k] += weight * start.dt * (*there)[k];
        for (std::size_t k = 0; k < X.size(); ++k)
          motion_bar[k] += scheme.b[s] * costates[j].workpiece.velocity[k];
        reverse_motion(at->stage, at->W, motion_bar, rhs, position_bar, bar.contact);
        Field<double> minus_rhs(scene_.discretization), lambda;
        minus_rhs.add(-1., rhs);
        auto &guesses = earlier_lambdas_[s][j];
        system_.solve_derivative(
          minus_rhs, tolerances[j], lambda, guesses, Transposition::transposed, &shared);
        reverse_residual(view, lambda, stage_bar);
        guesses.insert(guesses.begin(), std::move(lambda));
        guesses.resize(std::min(guesses.size(), n_starts));
        if (s == 0)
          reverse_contact_set(scene_.view(start.physics.dies, X, &state.velocity),
                              start.contact,
                              record.contact.ramp_in(record.step),
                              bar.contact.part(),
                              position_bar.part(),
                              bar.velocity.part(),
                              physics.dies);
        bar.Y[s] = position_bar.complete();
        if (process.material.depends_on_state())
          bar.history.take(scene_, process.heat.warms(), s, bar.physics);
      }
    }
    for (std::size_t j = 0; j < costates.size(); ++j)
    {
      WorkpieceState<3, double> &workpiece = costates[j].workpiece;
      PhysicsBar                &physics   = bars[j].physics.part();
      for (unsigned int s = n; s-- > 0;)
        for (std::size_t k = 0; k < X.size(); ++k)
          workpiece.X[k] += bars[j].Y[s][k];
      workpiece.velocity = bars[j].velocity.complete();
      bars[j].history.add_to(workpiece);
      reverse_over(process, place(record), record.contact.approach, physics, costates[j].process.part());
    }
  }
} // namespace retroforge
