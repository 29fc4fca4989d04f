// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Every term of the backward sweep is needed, and tests of this kind can see it: on a small block under a
// tilted die, with a soft penalty, the adjoint agrees with replayed central differences along three
// directions (all nodes at random, the nodes in contact lifted off their die, the speed of the die); and a
// sweep that leaves out any one term does not. The sweep with omissions is the test's own, built from the
// library's kernels: complete, it agrees with adjoint_sweep. The times of an increment depend on the speed
// alone, so their terms must show along that direction, all others along the two that move nodes.

#include <deal.II/base/mpi.h>

#include "recorded_run.h"

#include <retroforge/parameters.h>

#include <iostream>
#include <random>

using namespace retroforge;

namespace
{
  enum class Term
  {
    none,
    gap,           // d delta / dX
    area,          // d S / dX
    friction_area, // d S^f / dX
    ramp,          // w'(delta)
    lambda_bubble, // bubble part of lambda in lambda·dR/dX
    power_bubble,  // dPhi / dbeta
    first_stage,   // the solve at X_i that the midpoint comes from
    dt,            // of the increment, by the die's speed
    tau            // approach time, by the die's speed
  };

  const std::vector<std::pair<Term, std::string>> terms = {{Term::gap, "d delta/dX"},
                                                           {Term::area, "d S/dX"},
                                                           {Term::friction_area, "d S^f/dX"},
                                                           {Term::ramp, "w'(delta)"},
                                                           {Term::lambda_bubble, "bubble part of lambda"},
                                                           {Term::power_bubble, "dPhi/dbeta"},
                                                           {Term::first_stage, "lambda of the first stage"},
                                                           {Term::dt, "d dt/d(speed)"},
                                                           {Term::tau, "d tau/d(speed)"}};

  using Problem = RecordedRun;

  /// The contact's part of a reverse sweep; `reverse_node` is that of one node.
  template <typename NodeReverse>
  void reverse_contact(const Stage<double>  &stage,
                       const Term            omitted,
                       const NodeReverse    &reverse_node,
                       NodalVectors<double> &X_bar,
                       ContactSetBar        &contact_bar,
                       PhysicsBar           &bar)
  {
    const std::size_t    n = stage.contact.pairs.size();
    ContactAreas<double> areas_bar{std::vector<double>(n, 0.), std::vector<double>(n, 0.)};
    for (unsigned int p = 0; p < n; ++p)
    {
      const ContactNodeBar node = reverse_node(p);
      areas_bar.S[p]            = omitted == Term::area ? 0. : node.S;
      areas_bar.Sf[p]           = omitted == Term::friction_area ? 0. : node.Sf;
      contact_bar.delta[p] += node.delta;
      contact_bar.n[p] += node.n;
      bar.contact.tau += node.tau;
      bar.contact.dies[stage.contact.pairs[p].die].velocity -= node.u;
    }
    reverse_contact_areas(
      stage.scene.mesh, stage.scene.topology, stage.contact, stage.X, areas_bar, X_bar, contact_bar);
  }

  /// Derivatives of dt * power; returns those in W.
  Field<double> reverse_energy(const Stage<double>  &stage,
                               const Field<double>  &W,
                               const ActiveSet      &active,
                               const double          dt,
                               const Term            omitted,
                               NodalVectors<double> &X_bar,
                               ContactSetBar        &contact_bar,
                               PhysicsBar           &bar)
  {
    const TetMesh &mesh = stage.scene.mesh;
    Field<double>  W_bar(mesh);
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    {
      CellValues<double> w_bar = {};
      const auto         s     = reverse_cell_dissipation(
        cell_geometry(positions_of_cell(mesh, stage.X, c)), W.on_cell(mesh, c), stage.physics.law, dt, w_bar);
      for (unsigned int a = 0; a < 4; ++a)
      {
        X_bar[mesh.cells[c][a]] += s.X[a];
        W_bar.V[mesh.cells[c][a]] += w_bar.V[a];
      }
      if (omitted != Term::power_bubble)
        W_bar.beta[c] += w_bar.beta;
    }
    const auto reverse_node = [&](const unsigned int p) {
      const auto node = reverse_friction_power(
        stage.contact_node(p, W, active), stage.physics.law, stage.physics.contact, dt);
      W_bar.V[stage.contact.pairs[p].node] += node.u;
      return node;
    };
    reverse_contact(stage, omitted, reverse_node, X_bar, contact_bar, bar);
    const auto [deformation, friction] = stage.power(W, active);
    bar.dt += deformation + friction;
    return W_bar;
  }

  /// Derivatives of lambda·R.
  void reverse_equilibrium(const Stage<double>  &stage,
                           const Field<double>  &W,
                           const ActiveSet      &active,
                           Field<double>         lambda,
                           const Term            omitted,
                           NodalVectors<double> &X_bar,
                           ContactSetBar        &contact_bar,
                           PhysicsBar           &bar)
  {
    const TetMesh &mesh = stage.scene.mesh;
    if (omitted == Term::lambda_bubble)
      lambda.beta.assign(mesh.n_cells(), Vec3());
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    {
      const auto s = reverse_cell_residual(cell_geometry(positions_of_cell(mesh, stage.X, c)),
                                           W.on_cell(mesh, c),
                                           lambda.on_cell(mesh, c),
                                           stage.physics.law);
      for (unsigned int a = 0; a < 4; ++a)
        X_bar[mesh.cells[c][a]] += s.X[a];
    }
    const auto reverse_node = [&](const unsigned int p) {
      return reverse_contact_force(stage.contact_node(p, W, active),
                                   stage.physics.law,
                                   stage.physics.contact,
                                   lambda.V[stage.contact.pairs[p].node]);
    };
    reverse_contact(stage, omitted, reverse_node, X_bar, contact_bar, bar);
  }

  /// Reverse of one midpoint increment for the energy, as Increment::reverse has it, without the omitted
  /// term.
  void reverse_increment(Problem                    &problem,
                         const NodalVectors<double> &X,
                         const IncrementRecord      &record,
                         const Term                  omitted,
                         NodalVectors<double>       &G,
                         ProcessBar                 &process_bar)
  {
    const Scene             &scene   = problem.scene;
    const Physics<double>    physics = problem.process.at_stroke(record.stroke);
    const double             dt      = record.step / problem.process.speed();
    const ContactSet<double> contact = make_contact_set(scene.mesh,
                                                        scene.topology,
                                                        scene.dies,
                                                        physics.dies,
                                                        record.pairs,
                                                        problem.model.step.ramp,
                                                        problem.model.step.approach * dt,
                                                        X,
                                                        problem.model.step.layer);
    ContactSetBar            contact_bar(record.pairs.size());
    PhysicsBar               bar(scene.dies.size());
    NodalVectors<double>     next = G; // dPhi/d(where the stage's velocity leads): X_{i+1}, then Y
    for (unsigned int s = 2; s-- > 0;)
    {
      const double               reach = s == 1 ? dt : 0.5 * dt;
      const SolveRecord         &solve = record.solves[s];
      const NodalVectors<double> position =
        s == 0 ? X : problem.leg->increment.stage_positions(problem.process, X, record);
      const Stage<double> stage(scene, physics, contact, position);
      Field<double>       W(scene.mesh), rhs(scene.mesh), minus_rhs(scene.mesh), lambda;
      W.V = solve.V;
      W.P = solve.P;
      recover_bubbles(stage, W);
      NodalVectors<double> X_bar(X.size());
      if (s == 1)
        rhs = reverse_energy(stage, W, solve.active, dt, omitted, X_bar, contact_bar, bar);
      for (std::size_t k = 0; k < X.size(); ++k)
      {
        bar.dt += reach / dt * (next[k] * W.V[k]);
        rhs.V[k] += reach * next[k];
      }
      minus_rhs.add(-1., rhs);
      problem.leg->system.assemble(stage, W, solve.active);
      problem.leg->system.solve(minus_rhs, problem.model.step.adjoint_tolerance, lambda);
      if (s == 0 && omitted == Term::first_stage)
        lambda = Field<double>(scene.mesh);
      reverse_equilibrium(stage, W, solve.active, lambda, omitted, X_bar, contact_bar, bar);
      for (std::size_t k = 0; k < X.size(); ++k)
        G[k] += X_bar[k];
      next = X_bar;
    }
    if (omitted == Term::gap)
      contact_bar.delta.assign(record.pairs.size(), 0.);
    if (omitted == Term::ramp)
      contact_bar.ramp.assign(record.pairs.size(), 0.);
    if (omitted == Term::dt)
      bar.dt = 0.;
    if (omitted == Term::tau)
      bar.contact.tau = 0.;
    reverse_contact_set(
      scene.dies, physics.dies, contact, problem.model.step.ramp, X, contact_bar, G, bar.contact);
    process_bar.add(bar, problem.process, {record.stroke, record.step}, problem.model.step.approach);
  }

  AdjointResult sweep(Problem &problem, const Term omitted)
  {
    AdjointResult        result{NodalVectors<double>(problem.forged.X.size()),
                         ProcessBar(problem.scene.dies.size())};
    NodalVectors<double> X = problem.forged.X;
    for (unsigned int i = problem.records.size(); i-- > 0;)
    {
      const IncrementRecord &record = problem.records[i];
      for (std::size_t k = 0; k < X.size(); ++k)
        X[k] -= record.step / problem.process.speed() * record.solves.back().V[k];
      reverse_increment(problem, X, record, omitted, result.X_0, result.process);
    }
    return result;
  }

  /// A direction in (X_0, relative speed of the upper die).
  struct Direction
  {
    std::string          name;
    NodalVectors<double> X_dot;
    double               speed_dot;
  };

  std::vector<Direction> directions(const Problem &problem)
  {
    std::mt19937                           generator(1);
    std::uniform_real_distribution<double> uniform(-1., 1.);
    const NodalVectors<double>             still(problem.forged.X.size());
    std::vector<Direction>                 list = {
                      {"random X_0", still, 0.}, {"contact nodes lifted", still, 0.}, {"die speed", still, 1.}};
    for (Vec3 &x : list[0].X_dot)
      for (unsigned int i = 0; i < 3; ++i)
        x[i] = uniform(generator);
    // Each by another amount: a common one would move the whole billet.
    for (const ContactPair &pair : problem.records[0].pairs)
      if (pair.touching)
        list[1].X_dot[pair.node] -=
          (1.5 + uniform(generator)) *
          problem.scene.dies[pair.die].project(problem.scene.mesh.X[pair.node], Vec3(), pair.feature).n;
    return list;
  }

  double slope(const Problem &problem, const AdjointResult &result, const Direction &direction)
  {
    double sum = direction.speed_dot * (result.process.dies[1].velocity * problem.process.dies[1].velocity);
    for (std::size_t k = 0; k < result.X_0.size(); ++k)
      sum += result.X_0[k] * direction.X_dot[k];
    return sum;
  }

  double replayed_energy(Problem &problem, const Direction &direction, const double h)
  {
    Process<double>      process = problem.process;
    NodalVectors<double> X       = problem.scene.mesh.X;
    process.dies[1].velocity *= 1. + h * direction.speed_dot;
    for (std::size_t k = 0; k < X.size(); ++k)
      X[k] += h * direction.X_dot[k];
    return problem.replayed_energy(process, X);
  }

  double error(const double a, const double b)
  {
    return std::abs(a / b - 1.);
  }

  const char *yes(const bool condition)
  {
    return condition ? "yes" : "NO";
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  Problem                                  problem(tilted_block());
  const auto                               along   = directions(problem);
  const AdjointResult                      library = problem.adjoint(), complete = sweep(problem, Term::none);
  std::vector<double>                      differences;
  std::cout << "complete sweep\n";
  for (const Direction &direction : along)
  {
    const double h = direction.speed_dot == 0. ? 1e-6 : 1e-5;
    differences.push_back((replayed_energy(problem, direction, h) - replayed_energy(problem, direction, -h)) /
                          (2. * h));
    const double adjoint = slope(problem, complete, direction);
    std::cout << "  " << direction.name
              << ": differences within 1e-7: " << yes(error(adjoint, differences.back()) < 1e-7)
              << ", adjoint_sweep within 1e-13: "
              << yes(error(adjoint, slope(problem, library, direction)) < 1e-13) << "\n";
  }
  for (const auto &[term, name] : terms)
  {
    const AdjointResult without = sweep(problem, term);
    std::cout << "without " << name << "\n";
    for (std::size_t d = 0; d < along.size(); ++d)
    {
      const double found = error(slope(problem, without, along[d]), differences[d]);
      const bool   times = term == Term::dt || term == Term::tau;
      if (times == (along[d].speed_dot != 0.))
        std::cout << "  " << along[d].name << ": error > 1e-6: " << yes(found > 1e-6) << "\n";
    }
  }
}
