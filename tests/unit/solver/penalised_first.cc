// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The right-hand side of a system whose solution moves all nodes, those that a die holds too: the penalty
// times their velocity, which after scaling dwarfs the rest of it, as where a die moves. Proved, for linear
// and for quadratic velocities: with penalised rows solved first, all other unknowns are found to the
// tolerance; solved at once, they are not. A start in which penalised components alone are wrong is as good
// as the solution. What a solve has found spares another right-hand side of the same matrix iterations. A shared tolerance is relative to the largest right-hand side so far, and 1e-2 at most.

#include <deal.II/base/mpi.h>

#include <retroforge/solver/saddle_solver.h>

#include "corner_stage.h"

using namespace retroforge;

namespace
{
  constexpr double tolerance = 1e-10;

  /// Of what is not penalised, relative.
  double difference(const SaddleSystem &system, const la::BlockVector &x, const la::BlockVector &y)
  {
    la::BlockVector d(x), size(y);
    d.add(-1., y);
    for (const unsigned int row : system.penalised)
      d.block(0).begin()[row] = size.block(0).begin()[row] = 0.;
    return d.l2_norm() / size.l2_norm();
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const ElementPair pair : {ElementPair::mini, ElementPair::taylor_hood})
  {
    Random       random;
    CornerStage  corner(random, 1e9, pair);
    SaddleMatrix matrix(corner.scene);
    matrix.assemble(corner.stage(), corner.W, corner.active, Linearisation::newton);
    const SaddleSystem    &system = matrix.system();
    la::BlockVector        exact  = matrix.vector(), b(exact), at_once(exact), first(exact);
    Timings                timings;
    LinearSolverParameters parameters;
    SaddleSolver           solver(system, parameters, timings);
    matrix.load_guess(corner.random_field(random), Transposition::plain, exact);
    system.matrix.vmult(b, exact);
    solver.solve(b, tolerance, {}, Transposition::plain, at_once);
    SharedTolerance fine{tolerance}, rough{1e-6};
    solver.solve_penalised_first(b, fine, {}, Transposition::plain, first);
    la::BlockVector guess(exact);
    for (const unsigned int row : system.penalised)
      guess.block(0).begin()[row] += 1.;
    la::BlockVector    again(exact);
    const unsigned int n_again =
      solver.solve_penalised_first(b, rough, {guess}, Transposition::transposed, again);
    // Another right-hand side, with what a solve with the same matrix has found, and without.
    la::BlockVector other(exact), alone(exact), with(exact);
    KrylovSpace     shared;
    solver.solve_penalised_first(b, fine, {}, Transposition::plain, with, &shared);
    matrix.load_guess(corner.random_field(random), Transposition::plain, other);
    system.matrix.vmult(b, other);
    const unsigned int n_alone = solver.solve_penalised_first(b, fine, {}, Transposition::plain, alone);
    const unsigned int n_with =
      solver.solve_penalised_first(b, fine, {}, Transposition::plain, with, &shared);
    const double error = difference(system, first, exact), error_at_once = difference(system, at_once, exact);
    std::cout << (pair == ElementPair::mini ? "linear" : "quadratic")
              << " velocities, penalised: " << (system.penalised.size() > 10 ? "yes" : "NO")
              << "; first, within 1000 tolerances: " << (error < 1000. * tolerance ? "yes" : "NO")
              << "; at once, beyond: " << (error_at_once > 1000. * tolerance ? "yes" : "NO")
              << "; from a start with other penalised components, in " << n_again
              << " iterations: " << (difference(system, again, exact) < 1000. * tolerance ? "yes" : "NO")
              << "; another, as exact: "
              << (difference(system, with, other) < 1000. * tolerance ? "yes" : "NO")
              << ", in fewer iterations: " << (n_with < n_alone ? "yes" : "NO") << "\n";
  }
  SharedTolerance   shared{1e-6};
  const std::vector expected    = {1e-6, 1e-6, 1e-5, 1e-2, 1e-6};
  bool              as_expected = true;
  std::size_t       i           = 0;
  for (const double norm : {1., 10., 1., 1e-7, 0.})
    as_expected = as_expected && std::abs(shared.next(norm) / expected[i++] - 1.) < 1e-12;
  std::cout << "shared tolerance: " << (as_expected ? "yes" : "NO") << "\n";
}
