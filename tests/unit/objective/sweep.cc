// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Objectives within a whole forging: on a small block under a tilted die, the gradient by a backward sweep
// that starts from a final objective, or takes up a path objective increment by increment, agrees with
// central differences of replays, along all nodes at random and along the speed of the die; and, for the
// shape, with the direct method. The accumulated strain is swept back with the positions. The sweep is the
// test's own, built from the library's kernels; for the energy it is that of dropped_terms.

#include <deal.II/base/mpi.h>

#include <retroforge/element/strain_history.h>
#include <retroforge/objective/contact_pressure.h>
#include <retroforge/objective/effort.h>
#include <retroforge/objective/energy.h>
#include <retroforge/objective/filling.h>
#include <retroforge/objective/fold.h>
#include <retroforge/objective/shape_distance.h>
#include <retroforge/objective/strain_statistics.h>
#include <retroforge/objective/unfilled_volume.h>

#include "../adjoint/recorded_run.h"
#include "../geometry/geometry_test_tools.h"
#include "objective_test_tools.h"

using namespace retroforge;

Parameters tilted_die()
{
  Parameters p;
  p.billet.size         = Vec3({30, 30, 30});
  p.billet.element_size = 14;
  p.dies                = {DieParameters("lower"), DieParameters("upper")};
  p.dies[0].facing      = Vec3({0, 0, 1});
  p.dies[1].point       = Vec3({15, -15, 30});
  p.dies[1].facing      = Vec3({-0.029809, 0.081900, -0.996195});
  p.dies[1].facing /= p.dies[1].facing.norm();
  p.dies[1].velocity = Vec3({0, 0, -100});
  for (DieParameters &die : p.dies)
    die.friction = 0.4;
  p.material.minimal_strain_rate = 0.3;
  p.press.stroke                 = 3.;
  p.press.increments             = 4;
  p.contact.approach             = 2.;
  p.contact.penetration          = 1e-2;
  p.contact.slip_fraction        = 0.1;
  p.newton.tolerance             = 1e-13;
  p.adjoint.tolerance            = 1e-13;
  p.linear_solver.method         = "direct";
  return p;
}

/// One recorded increment taken up again: its contact, last stage and solution.
struct Replayed
{
  Replayed(const RecordedRun          &run,
           const Process<double>      &process,
           const NodalVectors<double> &X,
           const IncrementRecord      &record)
      : physics(process.at_stroke(record.stroke))
      , dt(record.step / process.speed())
      , contact(make_contact_set(run.scene.mesh,
                                 run.scene.topology,
                                 run.scene.dies,
                                 physics.dies,
                                 record.pairs,
                                 run.model.step.ramp,
                                 run.model.step.approach * dt,
                                 X,
                                 run.model.step.layer))
      , Y(run.leg->increment.stage_positions(process, X, record))
      , W(run.leg->increment.last_field(process, X, record))
  {
  }

  PathRow<double>
  row(const RecordedRun &run, const PathObjective &objective, const IncrementRecord &record) const
  {
    const Stage<double> stage(run.scene, physics, contact, Y);
    return {objective.integrals({stage, W, record.solves.back().active}),
            dt,
            dt * record.stroke / record.step,
            record.stroke,
            record.step};
  }

  Physics<double>      physics;
  double               dt;
  ContactSet<double>   contact;
  NodalVectors<double> Y;
  Field<double>        W;
};

/// Where a replay ends, and what a path objective saw on the way.
struct Outcome
{
  PathRows<double>     rows;
  NodalVectors<double> X;
  std::vector<double>  q;
};

/// A replay: its process, the increments solved anew, and the positions before each and at the end.
struct Path
{
  Path(const RecordedRun &run, const Process<double> &process, const NodalVectors<double> &X_0)
      : process(process), records(run.records), X{X_0}
  {
    Field<double> W(run.scene.mesh);
    for (IncrementRecord &record : records)
    {
      W.V = record.solves[0].V;
      W.P = record.solves[0].P;
      X.push_back(run.leg->increment.forward(process, X.back(), true, record, W));
    }
  }

  Outcome outcome(const RecordedRun &run, const PathObjective &objective) const
  {
    Outcome outcome{{}, X.back(), std::vector<double>(run.scene.mesh.n_cells(), 0.)};
    for (std::size_t i = 0; i < records.size(); ++i)
    {
      const Replayed increment(run, process, X[i], records[i]);
      outcome.rows.push_back(increment.row(run, objective, records[i]));
      outcome.q = accumulate_strain(run.scene.mesh, increment.Y, increment.W, increment.dt, outcome.q);
    }
    return outcome;
  }

  Process<double>                   process;
  std::vector<IncrementRecord>      records;
  std::vector<NodalVectors<double>> X;
};

/// Replays by their place along the two directions of compare(): solved once for all objectives.
using Paths = std::map<std::pair<double, double>, Path>;

/// Derivatives in X_0 and the process, and those that the end begins with.
struct Sweep
{
  NodalVectors<double> G;
  std::vector<double>  q_bar;
  ProcessBar           process;
};

/// Reverse of one midpoint increment.
/// @param row_bar  of the path objective
void reverse_increment(RecordedRun                &run,
                       const NodalVectors<double> &X,
                       const IncrementRecord      &record,
                       const PathObjective        &objective,
                       const PathRow<double>      &row,
                       const PathRow<double>      &row_bar,
                       Sweep                      &sweep)
{
  const Scene         &scene = run.scene;
  const Replayed       increment(run, run.process, X, record);
  const double         dt = increment.dt;
  ContactSetBar        contact_bar(record.pairs.size());
  PhysicsBar           bar(scene.dies.size());
  NodalVectors<double> next = sweep.G; // of the positions that the stage's velocity leads to
  for (unsigned int s = 2; s-- > 0;)
  {
    const double         reach = s == 1 ? dt : 0.5 * dt;
    const Stage<double>  stage(scene, increment.physics, increment.contact, s == 1 ? increment.Y : X);
    const ActiveSet     &active = record.solves[s].active;
    Field<double>        W(scene.mesh), rhs(scene.mesh), minus_rhs(scene.mesh), lambda;
    NodalVectors<double> X_bar(X.size());
    W.V = record.solves[s].V;
    W.P = record.solves[s].P;
    recover_bubbles(stage, W);
    if (s == 1)
    {
      StageBar stage_bar{rhs, X_bar, contact_bar, bar};
      objective.reverse_integrals({stage, W, active}, row_bar.integrals, stage_bar);
      bar.dt += dt_bar(row, row_bar);
      bar.dt += reverse_accumulate_strain(scene.mesh, stage.X, W, dt, sweep.q_bar, rhs, X_bar);
    }
    for (std::size_t k = 0; k < X.size(); ++k)
    {
      bar.dt += reach / dt * (next[k] * W.V[k]);
      rhs.V[k] += reach * next[k];
    }
    minus_rhs.add(-1., rhs);
    run.leg->system.assemble(stage, W, active);
    run.leg->system.solve(minus_rhs, run.model.step.adjoint_tolerance, lambda);
    reverse_residual(stage, W, active, lambda, X_bar, contact_bar, bar);
    for (std::size_t k = 0; k < X.size(); ++k)
      sweep.G[k] += X_bar[k];
    next = X_bar;
  }
  reverse_contact_set(scene.dies,
                      increment.physics.dies,
                      increment.contact,
                      run.model.step.ramp,
                      X,
                      contact_bar,
                      sweep.G,
                      bar.contact);
  sweep.process.add(bar, run.process, {record.stroke, record.step}, run.model.step.approach);
}

/// The increments from the last to the first. @param rows_bar  zero for a final objective
void sweep_back(RecordedRun            &run,
                const PathObjective    &objective,
                const PathRows<double> &rows,
                const PathRows<double> &rows_bar,
                Sweep                  &sweep)
{
  NodalVectors<double> X = run.forged.X;
  for (unsigned int i = run.records.size(); i-- > 0;)
  {
    const IncrementRecord &record = run.records[i];
    for (std::size_t k = 0; k < X.size(); ++k)
      X[k] -= record.step / run.process.speed() * record.solves.back().V[k];
    reverse_increment(run, X, record, objective, rows[i], rows_bar[i], sweep);
  }
}

/// Compares a gradient with central differences of `value` along all nodes at random and along the speed.
template <typename Value>
void compare(const std::string &name,
             const RecordedRun &run,
             const Sweep       &sweep,
             const Value       &value,
             Paths             &paths,
             Errors            &errors)
{
  Random               random;
  NodalVectors<double> X_dot(run.forged.X.size());
  double               by_nodes = 0.;
  for (std::size_t k = 0; k < X_dot.size(); ++k)
  {
    X_dot[k] = random.vector();
    by_nodes += X_dot[k] * sweep.G[k];
  }
  const unsigned int upper    = run.process.leading_die;
  const double       by_speed = sweep.process.dies[upper].velocity * run.process.dies[upper].velocity;
  const auto         at       = [&](const double nodes, const double speed) {
    NodalVectors<double> X       = run.scene.mesh.X;
    Process<double>      process = run.process;
    for (std::size_t k = 0; k < X.size(); ++k)
      X[k] += nodes * X_dot[k];
    process.dies[upper].velocity *= 1. + speed;
    return value(paths.try_emplace({nodes, speed}, run, process, X).first->second);
  };
  // Fourth order: what cancels is far below what is left out.
  const auto difference = [&](const auto &f, const double h) {
    return (8. * (f(h) - f(-h)) - (f(2. * h) - f(-2. * h))) / (12. * h);
  };
  errors.compare(name + ", nodes", by_nodes, difference([&](const double t) { return at(t, 0.); }, 2e-4));
  errors.compare(name + ", speed", by_speed, difference([&](const double t) { return at(0., t); }, 1e-3));
}

void check_path(const std::string   &name,
                RecordedRun         &run,
                const PathObjective &objective,
                Paths               &paths,
                Errors              &errors)
{
  const Outcome forged = Path(run, run.process, run.scene.mesh.X).outcome(run, objective);
  Sweep         sweep{NodalVectors<double>(forged.X.size()),
              std::vector<double>(forged.q.size(), 0.),
              ProcessBar(run.scene.dies.size())};
  sweep_back(run, objective, forged.rows, objective.reverse_value(forged.rows), sweep);
  compare(
    name,
    run,
    sweep,
    [&](const Path &path) { return objective.value(path.outcome(run, objective).rows); },
    paths,
    errors);
}

/// The derivative of a final objective of the shape along the speed, by the direct method.
double tangent_in_speed(const RecordedRun &run, const FinalObjective &objective)
{
  const auto    constant = [](const Vec3 &v) { return Vector3<Dual>({Dual(v[0]), Dual(v[1]), Dual(v[2])}); };
  Process<Dual> process{{Dual(run.process.law.K), Dual(run.process.law.m), Dual(run.process.law.e0)},
                        {Dual(run.process.contact.rho), Dual(run.process.contact.v0)},
                        {},
                        run.process.leading_die};
  for (const auto &die : run.process.dies)
    process.dies.push_back({constant(die.velocity), constant(die.displacement), Dual(die.friction), {}});
  for (unsigned int i = 0; i < 3; ++i)
  {
    Dual &v           = process.dies[process.leading_die].velocity[i];
    v.fastAccessDx(0) = v.val();
  }
  NodalVectors<Dual> X;
  for (const Vec3 &x : run.scene.mesh.X)
    X.push_back(constant(x));
  for (const IncrementRecord &record : run.records)
    X = run.leg->increment.tangent(process, X, record, [](const StageView<Dual> &, const Dual &) {});
  const std::vector<Dual> no_strain(run.scene.mesh.n_cells(), Dual(0.));
  const auto              dies = process.at_stroke(0.).dies;
  return objective.value(objective.integrals(FinalView<Dual>{run.scene, X, no_strain, dies})).dx(0);
}

void check_final(const std::string &name,
                 RecordedRun       &run,
                 FinalObjective    &objective,
                 const bool         of_strain,
                 Paths             &paths,
                 Errors            &errors,
                 Errors            &tangent_errors)
{
  const EnergyObjective energy; // any: its rows are not used
  const auto            dies   = run.process.at_stroke(0.).dies;
  const Outcome         forged = Path(run, run.process, run.scene.mesh.X).outcome(run, energy);
  objective.decide({run.scene, forged.X, forged.q, dies});
  const auto integrals = objective.integrals({run.scene, forged.X, forged.q, dies});
  FinalBar   bar(run.scene);
  objective.reverse_integrals({run.scene, forged.X, forged.q, dies}, objective.reverse_value(integrals), bar);
  Sweep            sweep{bar.X, bar.q, ProcessBar(run.scene.dies.size())};
  PathRows<double> rows_bar = forged.rows;
  for (PathRow<double> &row : rows_bar)
    row = {std::vector<double>(row.integrals.size(), 0.), 0., 0., row.stroke, row.step};
  sweep_back(run, energy, forged.rows, rows_bar, sweep);
  const unsigned int upper = run.process.leading_die;
  if (!of_strain)
    tangent_errors.compare(name + ", tangent",
                           sweep.process.dies[upper].velocity * run.process.dies[upper].velocity,
                           tangent_in_speed(run, objective));
  compare(
    name,
    run,
    sweep,
    [&](const Path &path) {
      const Outcome outcome = path.outcome(run, energy);
      return objective.value(objective.integrals({run.scene, outcome.X, outcome.q, dies}));
    },
    paths,
    errors);
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  RecordedRun                              run(tilted_die());
  Errors                                   errors, tangents;
  Paths                                    paths;
  const unsigned int                       upper = run.process.leading_die;
  const PathWindow late{PathWindow::Over::stroke, 1.1, 3.}, early{PathWindow::Over::time, 0.002, 0.019};
  check_path("energy", run, EnergyObjective(), paths, errors);
  check_path("mean effort", run, MeanEffort(Effort(upper), late), paths, errors);
  check_path("mean force", run, MeanEffort(Effort(upper, Effort::By::force), early), paths, errors);
  check_path("maximum effort", run, MaximumEffort(Effort(upper), early, {}), paths, errors);
  check_path("fold", run, FoldObjective(3.), paths, errors);
  check_path("dimensionless fold", run, DimensionlessFold(3.), paths, errors);
  check_path("contact pressure", run, ContactPressure(upper, 6., 10.), paths, errors);

  NodalVectors<double> ball = sphere(2).vertices();
  for (Vec3 &x : ball)
    x = 24. * x + Vec3({1., 2., 14.});
  const TargetSurface target(std::make_shared<TriangleSurface>("ball", ball, sphere(2).triangles()));
  StrainObjective     variance(StrainStatistic::variance), maximum(StrainStatistic::maximum);
  ShapeDistance       distance(target);
  FillingObjective    filling(target, 0.01);
  UnfilledVolume      unfilled(target, Cavity::within, 24, 4.);
  check_final("variance of the strain", run, variance, true, paths, errors, tangents);
  check_final("maximum strain", run, maximum, true, paths, errors, tangents);
  check_final("shape distance", run, distance, false, paths, errors, tangents);
  check_final("filling", run, filling, false, paths, errors, tangents);
  check_final("unfilled volume", run, unfilled, false, paths, errors, tangents);
  tangents.print(1e-10);
  errors.print(1e-7);
  std::cout << "FIGURE objective_gradient_error " << errors.largest() << std::endl;
}
