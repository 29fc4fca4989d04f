// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/mpi.h>

#include <retroforge/solver/hold_forces.h>
#include <retroforge/solver/rigid_modes.h>
#include <retroforge/solver/stage_motion.h>
#include <retroforge/steps/mechanics.h>

namespace retroforge
{
  template <typename Number>
  IncrementStart<Number>::IncrementStart(const Scene                     &scene,
                                         const Process<Number>           &process,
                                         const WorkpieceState<3, Number> &state,
                                         const IncrementRecord           &record)
      : physics(process.over(place(record)))
      , dt(process.duration(place(record)))
      , contact(make_contact_set<Number>(scene.view(physics.dies, state.X, &state.velocity),
                                         record.pairs,
                                         {record.contact.ramp_in(record.step),
                                          Number(record.contact.approach * dt),
                                          record.contact.approach_law(record.step),
                                          record.contact.edge_stiffness,
                                          record.contact.counts_closing}))
      , history(scene, process, state)
  {
    contact.hold = record.hold;
  }

  template struct IncrementStart<double>;
  template struct IncrementStart<Dual>;

  SolvedStage::SolvedStage(const Scene                  &scene,
                           const IncrementStart<double> &start,
                           const unsigned int            s,
                           NodalVectors<double>          positions,
                           const SolveRecord            &solve,
                           const double                  weight,
                           const NodeVector<3, double>  &bubbles)
      : X(std::move(positions))
      , active(solve.active)
      , weight(weight)
      , stage(scene, start.physics, start.contact, X, start.history.points(s))
      , W(scene.discretization)
  {
    if (!bubbles.empty())
      W.V = bubbles;
    W.V.take(solve.V);
    W.P.take(solve.P);
    solve_bubbles(stage, W);
  }

  Mechanics::Mechanics(const Scene            &scene,
                       const StepModel        &model,
                       const NewtonParameters &newton,
                       LinearSystem           &system,
                       Timings                &timings)
      : scene_(scene), model_(model), system_(system), newton_(scene, newton, system), timings_(timings)
  {
  }

  bool Mechanics::contacts_missed(const Equilibrium<double> &stage, const Field<double> &W) const
  {
    const auto                     timing = timings_.scope("checks");
    const auto                    &nodes  = *scene_.discretization.condensed_nodes();
    std::vector<std::vector<bool>> watched(scene_.dies.size(), std::vector<bool>(nodes.n(), false));
    for (const ContactPair &pair : stage.contact.pairs)
      if (pair.point.has_own_velocity())
        watched[pair.die][pair.point.velocity_node] = true;
    // A point that was not watched must not have run into a die. Each rank looks at its own.
    const auto runs_into = [&](const unsigned int d, const ContactPoint &point) {
      if (!nodes.owns(point.velocity_node) || watched[d][point.velocity_node] ||
          stage.physics.dies[d].in_press == 0)
        return false;
      const auto  &die = stage.physics.dies[d];
      const Vec3   u = point.velocity(W.V) - die.velocity, x = point.position(stage.X);
      const double reach   = approach_distance(u.norm(), stage.contact.tau, stage.contact.approach);
      const auto   feature = scene_.dies[d].closest(x, die.displacement, reach);
      if (!feature.found())
        return false;
      const auto projection = scene_.dies[d].project(x, die, feature);
      return u * projection.n > approach_speed(projection.delta, stage.contact.tau, stage.contact.approach);
    };
    bool       found = false;
    const auto look  = [&](const ContactPoint &point) {
      for (unsigned int d = 0; d < scene_.dies.size() && !found; ++d)
        found = runs_into(d, point);
    };
    for (NodeIndex k = 0; k < stage.X.size(); ++k)
      if (scene_.topology.is_on_surface(k))
        look(ContactPoint::node(k));
    if (const MiddleNodes *middles = scene_.discretization.middles())
      for (const auto &[a, b] : scene_.topology.surface_edges)
        look(ContactPoint::middle(a, b, middles->between(a, b)));
    return dealii::Utilities::MPI::max(found ? 1 : 0, scene_.discretization.comm()) > 0;
  }

  std::shared_ptr<IncrementStart<double>> Mechanics::start_of(const Process<double>           &process,
                                                              const WorkpieceState<3, double> &state,
                                                              const IncrementRecord           &record) const
  {
    const auto timing = timings_.scope("contact");
    return std::make_shared<IncrementStart<double>>(scene_, process, state, record);
  }

  std::shared_ptr<IncrementStart<double>> Mechanics::recorded_start(const Process<double>           &process,
                                                                    const WorkpieceState<3, double> &state,
                                                                    const IncrementRecord &record) const
  {
    auto          start  = start_of(process, state, record);
    const Scheme &scheme = scheme_of(record);
    for (unsigned int s = 0; s + 1 < scheme.n_stages() && start->history.is_needed(); ++s)
      start->history.add(
        scheme, s, recorded_stage(*start, state.X, scheme, record.solves, s)->view(), start->dt);
    return start;
  }

  const Scheme &Mechanics::scheme_of(const IncrementRecord &record) const
  {
    return record.scheme == model_.scheme.name ? model_.scheme : Scheme::by_name(record.scheme);
  }

  std::vector<SolveRecord> Mechanics::solve_stages(IncrementStart<double>     &start,
                                                   const NodalVectors<double> &X,
                                                   const bool                  replay,
                                                   const bool                  all_found,
                                                   const InitialGuess         &guess,
                                                   IncrementRecord            &record)
  {
    Field<double>            W      = guess.W;
    const Scheme            &scheme = scheme_of(record);
    std::vector<SolveRecord> solves;
    const unsigned int       solves_before = system_.n_solves;
    bool                     lost          = false;
    for (unsigned int s = 0; s < scheme.n_stages() && !lost; ++s)
    {
      const NodalVectors<double> position = advanced(X, start.dt, scheme.a[s], solves);
      const Equilibrium<double>  stage(
        scene_, start.physics, start.contact, position, start.history.points(s));
      const ActiveChoice frozen = replay ? ActiveChoice(record.solves[s].active) : ActiveChoice();
      const Origin       origin = s == 0 ? guess.origin : Origin::previous;
      guess.advance(s == 0 ? guess.ahead : record.step * (scheme.node(s) - scheme.node(s - 1)), W);
      const NewtonStatistics statistics =
        newton_.solve(stage, W, frozen, origin, s == 0 ? ActiveChoice() : ActiveChoice(solves.back().active));
      record.newton += statistics.iterations;
      record.krylov += statistics.krylov;
      solves.push_back({W.V.complete(*scene_.discretization.condensed_nodes()),
                        W.P.complete(*scene_.discretization.pressure_nodes()),
                        replay ? *frozen : stage.decide_active(W)});
      if (scene_.discretization.middles())
        solves.back().vertices = motion(stage, W);
      lost = !replay && !all_found && contacts_missed(stage, W);
      // As a replay will have it.
      if (!lost && start.history.is_needed() && s + 1 < scheme.n_stages())
        start.history.add(scheme, s, recorded_stage(start, X, scheme, solves, s)->view(), start.dt);
    }
    record.linear_solves += system_.n_solves - solves_before;
    if (lost)
      solves.clear();
    return solves;
  }

  void Mechanics::account(const SolvedIncrement &solved, IncrementRecord &record) const
  {
    const std::size_t   n_dies = scene_.dies.size();
    std::vector<double> terms(n_power_terms(n_dies), 0.);
    record.forces.assign(n_dies, Vec3());
    record.hold_load = {};
    for (const auto &stage : solved.stages)
    {
      const HoldLoad load = hold_load(stage->view());
      record.hold_load.force += stage->weight * load.force;
      record.hold_load.moment += stage->weight * load.moment;
      const auto whole =
        RankSum<std::vector<double>>(power_terms(stage->view()), scene_.discretization.comm()).complete();
      for (std::size_t k = 0; k < terms.size(); ++k)
        terms[k] += stage->weight * whole[k];
      const std::vector<Vec3> forces = die_forces(stage->stage, stage->W, stage->active);
      for (unsigned int d = 0; d < n_dies; ++d)
        record.forces[d] += stage->weight * forces[d];
    }
    const EnergyParts<double> spent = spent_power(terms);
    const double              dt    = solved.start->dt;
    record.deformation_energy       = dt * spent.deformation;
    record.friction_energy          = dt * spent.friction;
    record.closing_energy           = dt * spent.closing;
    record.closing_work             = dt * closing_power(terms);
    const double factor             = force_factor(terms);
    for (Vec3 &force : record.forces)
      force *= factor;
  }

  SolvedIncrement Mechanics::forward(const Process<double>           &process,
                                     const WorkpieceState<3, double> &state,
                                     const bool                       replay,
                                     const InitialGuess              &guess,
                                     IncrementRecord                 &record)
  {
    const NodalVectors<double> &X = state.X;
    AssertDimension(X.size(), scene_.mesh.n_nodes());
    AssertDimension(process.dies.size(), scene_.dies.size());
    Assert(guess.W.belongs_to(scene_.discretization),
           dealii::ExcMessage("the guess is of another discretisation than the increment"));
    Assert(record.step > 0., dealii::ExcMessage("an increment has a stroke"));
    Assert(!replay || record.solves.size() == scheme_of(record).n_stages(),
           dealii::ExcMessage("a replay obeys a record of each stage"));
    const Physics<double> physics = process.over(place(record));
    if (!replay)
    {
      record.scheme = model_.scheme.name;
      if (record.contact.step == 0.)
        record.contact = model_.contact;
    }
    // A run that is resumed must not differ from one that was not.
    system_.reset();
    std::size_t  n_watched   = 0;
    const double least_reach = model_.reach * (record.contact.step / model_.contact.step);
    for (double reach = least_reach;; reach *= 2.)
    {
      // A wider search that finds nothing more has found all there is.
      bool all_found = false;
      if (!replay)
      {
        const auto timing = timings_.scope("contact");
        record.pairs      = find_contact_pairs(scene_.view(physics.dies, X, &state.velocity),
                                          record.contact.ramp_in(record.step),
                                          reach,
                                          model_.edges_touch);
        all_found         = reach > least_reach && record.pairs.size() == n_watched;
        n_watched         = record.pairs.size();
      }
      auto start = start_of(process, state, record);
      if (!replay)
      {
        record.hold = model_.holds_loose ? hold_of_loose(scene_,
                                                         physics,
                                                         scene_.view(physics.dies, X),
                                                         record.pairs,
                                                         record.contact.near_in(record.step))
                                         : RigidHold();
        if (!record.hold.empty() || !start->contact.hold.empty())
          start = start_of(process, state, record);
      }
      auto solves = solve_stages(*start, X, replay, all_found, guess, record);
      if (solves.empty())
        continue;
      record.solves          = std::move(solves);
      SolvedIncrement solved = recorded(start, X, record);
      account(solved, record);
      return solved;
    }
  }

  std::shared_ptr<const SolvedStage> Mechanics::recorded_stage(const IncrementStart<double>   &start,
                                                               const NodalVectors<double>     &X,
                                                               const Scheme                   &scheme,
                                                               const std::vector<SolveRecord> &solves,
                                                               const unsigned int              s,
                                                               const NodeVector<3, double>    &bubbles) const
  {
    return std::make_shared<const SolvedStage>(
      scene_, start, s, advanced(X, start.dt, scheme.a[s], solves), solves[s], scheme.b[s], bubbles);
  }

  SolvedIncrement Mechanics::recorded(std::shared_ptr<const IncrementStart<double>> start,
                                      const NodalVectors<double>                   &X,
                                      const IncrementRecord                        &record) const
  {
    const Scheme   &scheme = scheme_of(record);
    SolvedIncrement solved{start, {}, advanced(X, start->dt, scheme.b, record.solves), mean_velocity(record)};
    for (unsigned int s = 0; s < scheme.n_stages(); ++s)
      if (scheme.b[s] != 0.)
        solved.stages.push_back(recorded_stage(*start, X, scheme, record.solves, s));
    return solved;
  }

  SolvedIncrement Mechanics::recorded(const Process<double>           &process,
                                      const WorkpieceState<3, double> &state,
                                      const IncrementRecord           &record) const
  {
    return recorded(recorded_start(process, state, record), state.X, record);
  }

  NodalVectors<double> Mechanics::mean_velocity(const IncrementRecord &record) const
  {
    const NodalVectors<double> still(record.solves.front().motion().size());
    return advanced(still, 1., scheme_of(record).b, record.solves);
  }

  std::optional<Field<double>> Mechanics::rate(const IncrementRecord &record) const
  {
    const Scheme &scheme = scheme_of(record);
    const double  stroke = record.step * (scheme.node(scheme.n_stages() - 1) - scheme.node(0));
    if (stroke == 0.)
      return {};
    Field<double>      rate(scene_.discretization);
    const SolveRecord &first = record.solves.front(), &last = record.solves.back();
    rate.V.take(last.V);
    rate.P.take(last.P);
    Field<double> start(scene_.discretization);
    start.V.take(first.V);
    start.P.take(first.P);
    rate.add(-1., start);
    for (Vec3 &v : rate.V)
      v /= stroke;
    for (double &p : rate.P)
      p /= stroke;
    return rate;
  }

  InitialGuess Mechanics::guess_after(const SolvedIncrement &solved, const IncrementRecord &record) const
  {
    const Scheme &scheme = scheme_of(record);
    return {solved.last().W,
            Origin::previous,
            rate(record),
            record.step * (1. - scheme.node(scheme.n_stages() - 1))};
  }

  InitialGuess Mechanics::recorded_guess(const IncrementRecord &record) const
  {
    Field<double> W(scene_.discretization);
    W.V.take(record.solves.front().V);
    W.P.take(record.solves.front().P);
    return {std::move(W), Origin::previous, rate(record)};
  }

  NodalVectors<double> Mechanics::positions_after(const Process<double>      &process,
                                                  const NodalVectors<double> &X,
                                                  const IncrementRecord      &record) const
  {
    return advanced(X, process.duration(place(record)), scheme_of(record).b, record.solves);
  }
} // namespace retroforge
