// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Newton's method for the corner of a billet between a wavy die and a plane. Proved, on one rank and on two:
// - settled bubbles are in equilibrium, and those that recover_bubbles() finds from nothing;
// - the equilibrium is reached from rest, and its bubbles are settled;
// - where dies are stiff, a solution is a start as good as it was: at most one step;
// - a start ahead of a solution, by the change that led to it, is less than half as far from the next one.

#include <deal.II/base/mpi.h>

#include <retroforge/core/timer.h>
#include <retroforge/discretization/element_pairs.h>
#include <retroforge/solver/newton.h>

#include "corner_stage.h"

#include <cstdio>

using namespace retroforge;

namespace
{
  const char *yes(const bool condition)
  {
    return condition ? "yes" : "NO";
  }

  Vec3 bubble(const CornerStage &corner, const Field<double> &W, const CellIndex c)
  {
    return MiniPair::bubble(corner.scene.discretization, W, c);
  }

  /// Largest of the bubbles' residuals.
  double bubble_residual(const CornerStage &corner, const Field<double> &W)
  {
    const Field<double> r       = corner.stage().residual(W, {});
    double              largest = 0.;
    for (const CellIndex c : corner.scene.discretization.visited_cells())
      largest = std::max(largest, bubble(corner, r, c).norm());
    return dealii::Utilities::MPI::max(largest, MPI_COMM_WORLD);
  }

  void bubbles(const CornerStage &corner)
  {
    Field<double> settled = corner.W, recovered = corner.W;
    solve_bubbles(corner.stage(), settled);
    recover_bubbles(corner.stage(), recovered);
    double change = 0., size = 0.;
    for (const CellIndex c : corner.scene.discretization.visited_cells())
    {
      change = std::max(change, (bubble(corner, settled, c) - bubble(corner, recovered, c)).norm());
      size   = std::max(size, bubble(corner, recovered, c).norm());
    }
    std::printf("bubbles: in equilibrium: %s, as from nothing: %s\n",
                yes(bubble_residual(corner, settled) < 1e-9 * bubble_residual(corner, corner.W)),
                yes(dealii::Utilities::MPI::max(change, MPI_COMM_WORLD) <
                    1e-8 * dealii::Utilities::MPI::max(size, MPI_COMM_WORLD)));
  }

  struct Solver
  {
    LinearSolverParameters linear;
    NewtonParameters       parameters;
    Timings                timings;
    LinearSystem           system;
    Newton                 newton;

    explicit Solver(const Scene &scene) : system(scene, linear, timings), newton(scene, parameters, system) {}
  };

  void starts(const double rho)
  {
    Random                 random;
    CornerStage            corner(random, rho);
    Solver                 solver(corner.scene);
    Field<double>          W(corner.scene.discretization);
    const NewtonStatistics from_rest = solver.newton.solve(corner.stage(), W, {});
    const ActiveSet        active    = corner.stage().decide_active(W);
    Field<double>          again     = W;
    const NewtonStatistics repeated =
      solver.newton.solve(corner.stage(), again, {}, Origin::previous, active);
    std::printf("penalty %g: from rest: %s, bubbles settled: %s, from its own solution: %s\n",
                rho,
                from_rest.residual <= solver.parameters.tolerance ? "solved" : "NOT SOLVED",
                yes(bubble_residual(corner, W) < 1e-9 * bubble_residual(corner, corner.W)),
                repeated.iterations <= 1 ? "at most one step" : "more steps");
  }

  void ahead()
  {
    Random        random;
    CornerStage   corner(random, 1e3);
    Solver        solver(corner.scene);
    Field<double> first(corner.scene.discretization);
    solver.newton.solve(corner.stage(), first, {});
    const NodalVectors<double> X = corner.X, V = corner.velocities(first);
    const auto                 move = [&](const double time) {
      for (NodeIndex k = 0; k < X.size(); ++k)
        corner.X[k] = X[k] + time * V[k];
    };
    constexpr double dt     = 2e-2;
    Field<double>    second = first;
    move(dt);
    solver.newton.solve(corner.stage(), second, {}, Origin::previous, corner.stage().decide_active(first));
    InitialGuess guess{second, Origin::previous, second, dt};
    guess.rate->add(-1., first);
    for (Vec3 &v : guess.rate->V)
      v *= 1. / dt;
    for (double &p : guess.rate->P)
      p *= 1. / dt;
    Field<double> start = second;
    guess.advance(dt, start);
    move(2. * dt);
    Field<double> third = second;
    solver.newton.solve(corner.stage(), third, {}, Origin::previous, corner.stage().decide_active(second));
    const auto distance = [&](const Field<double> &W) {
      double     sum  = 0.;
      const auto of_W = corner.velocities(W), of_third = corner.velocities(third);
      for (NodeIndex k = 0; k < of_W.size(); ++k)
        sum += (of_W[k] - of_third[k]).norm_square();
      return std::sqrt(sum);
    };
    std::printf("ahead: at most half as far: %s\n", yes(distance(start) < 0.5 * distance(second)));
    InitialGuess unknown{second};
    unknown.advance(dt, second);
    std::printf("where no rate is known, as it was: %s\n", yes(distance(second) == distance(unknown.W)));
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0)
    std::freopen("/dev/null", "w", stdout);
  Random            random;
  const CornerStage corner(random, 10.);
  bubbles(corner);
  for (const double rho : {1e4, 1e6})
    starts(rho);
  ahead();
}
