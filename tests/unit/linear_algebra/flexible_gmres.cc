// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Flexible GMRES, on one rank and on two. Proved:
// - an unsymmetric system of two blocks on a ring of nodes is solved as MUMPS solves it, with a preconditioner
//   that is another one each time; the residual that ended it is the true one; twice the same bits;
// - its directions and their images hold the solution; of another right-hand side they take all they can at once, and what
//   they leave is the residual;
// - with room for 6 directions it goes on from its last iterate, in more iterations, to the same solution;
// - a diagonal matrix of five values takes five iterations, no more and, with a limit of four, no less: what
//   it has then is the best so far, and a start;
// - where the solution lies in the first direction, nothing is left of the second, and x is exact;
// - a start that is good enough takes no iteration;
// - a matrix of zeros, and one of what is not a number, fail and leave x as it was.

#include <deal.II/base/mpi.h>

#include "ring.h"
#include <retroforge/linear_algebra/direct_solver.h>
#include <retroforge/linear_algebra/flexible_gmres.h>

#include <algorithm>
#include <iostream>
#include <limits>

using namespace retroforge;
using namespace dealii::Utilities::MPI;

namespace
{
  constexpr unsigned int n = 40;

  /// Entries by their global numbers, and `shift` on the diagonal.
  void fill(const NodeMatrix &view, const unsigned int first_row, const double size, const double shift)
  {
    for (unsigned int i = 0; i < view.n_rows(); ++i)
      for (unsigned int e = 0; e < view.row(i).n; ++e)
      {
        const unsigned int row = first_row + i, column = view.column(view.row(i).columns[e]);
        view.row(i).values[e] = size * std::sin(1. + 3.1 * row + 0.7 * column) + (row == column ? shift : 0.);
      }
  }

  struct System
  {
    la::BlockSparseMatrix M;
    la::BlockVector       b, x;

    explicit System(const NodeRange &nodes)
        : b(std::vector<dealii::IndexSet>{nodes.dofs(3), nodes.dofs(1)}, MPI_COMM_WORLD), x(b)
    {
      const auto pattern = std::make_shared<const NodePattern>(nodes, nodes, ring_neighbours(nodes, n));
      M.reinit(2, 2);
      for (const unsigned int i : {0, 1})
        for (const unsigned int j : {0, 1})
        {
          const unsigned int rows = i == 0 ? 3 : 1, columns = j == 0 ? 3 : 1;
          const NodeMatrix   view(M.block(i, j), pattern, rows, columns, MPI_COMM_WORLD);
          fill(view, rows * nodes.begin, i == j ? 0.5 : 1., i != j ? 0. : i == 0 ? 5. : -3.);
        }
      M.collect_sizes();
      for (const unsigned int i : {0, 1})
        for (unsigned int l = 0; l < b.block(i).locally_owned_size(); ++l)
          b.block(i).begin()[l] = std::cos(0.3 * (b.block(i).local_range().first + l) + i);
    }

    double residual(const BlockOperator &of) const
    {
      la::BlockVector r(b);
      of(r, x);
      r -= b;
      return r.l2_norm();
    }
  };

  /// Multiplies by a function of the global number of the row.
  template <typename F>
  BlockOperator diagonal(const F factor)
  {
    return [factor](la::BlockVector &y, const la::BlockVector &x) {
      for (unsigned int i = 0; i < x.n_blocks(); ++i)
        for (unsigned int l = 0; l < x.block(i).locally_owned_size(); ++l)
          y.block(i).begin()[l] = factor(x.block(i).local_range().first + l) * x.block(i).begin()[l];
    };
  }

  void say(const std::string &what, const bool good)
  {
    std::cout << what << ": " << (min(good ? 1 : 0, MPI_COMM_WORLD) == 1 ? "yes" : "NO") << "\n";
  }

  bool same_bits(const la::BlockVector &x, const la::BlockVector &y)
  {
    return std::equal(x.block(0).begin(), x.block(0).end(), y.block(0).begin()) &&
           std::equal(x.block(1).begin(), x.block(1).end(), y.block(1).begin());
  }

  void solve_ring(const NodeRange &nodes)
  {
    System                system(nodes);
    const la::BlockVector b = system.b;
    la::BlockVector      &x = system.x, exact(x);
    solve_by_mumps(system.M, b, exact);
    const BlockOperator M = [&](la::BlockVector &y, const la::BlockVector &v) { system.M.vmult(y, v); };
    unsigned int        n_applied;
    const BlockOperator P = [&](la::BlockVector &z, const la::BlockVector &r) {
      const double change = ++n_applied % 2;
      z                   = r;
      z.block(0) *= 0.2 + 0.1 * change;
      z.block(1) *= -0.3 + 0.1 * change;
    };
    const auto solve = [&](const unsigned int restart) {
      n_applied = 0;
      x         = 0.;
      return solve_by_flexible_gmres(M, P, b, x, 1e-12 * b.l2_norm(), 1000, restart);
    };
    const auto error = [&] {
      la::BlockVector e(x);
      e -= exact;
      return e.l2_norm() / exact.l2_norm();
    };

    const KrylovResult whole = solve(160);
    say("solved", whole.converged && error() < 1e-11);
    say("one application an iteration", whole.iterations == n_applied);
    say("its residual is the true one", system.residual(M) < 1.01e-12 * b.l2_norm());
    const la::BlockVector first = x;
    solve(160);
    say("same bits again", same_bits(first, x));
    x = 0.;
    KrylovSpace space;
    solve_by_flexible_gmres(M, P, b, x, 1e-12 * b.l2_norm(), 1000, 160, &space);
    la::BlockVector r(b), again(b), changed(b), left(b), other(b);
    again = 0.;
    space.reduce(again, r);
    say("its space has the solution", !space.empty() && r.l2_norm() < 2e-12 * b.l2_norm());
    // The rest of another right-hand side: what is left of it cannot be taken by the space, and is the residual.
    changed.block(0).begin()[0] += 1.;
    other = 0.;
    left  = changed;
    space.reduce(other, left);
    M(r, other);
    r.sadd(-1., 1., changed);
    r -= left;
    say("what it leaves is the residual", r.l2_norm() < 1e-11 * b.l2_norm());
    la::BlockVector twice(left);
    space.reduce(other, twice);
    twice -= left;
    say("of which it takes nothing more", twice.l2_norm() < 1e-11 * b.l2_norm());
    // A second and a third right-hand side: what solves before have found they take, and find less.
    KrylovSpace shared(2);
    solve(160);
    std::vector<unsigned int> iterations;
    bool                      solved = true;
    for (const double amount : {0., 1., 0.5})
    {
      la::BlockVector rhs(b), rest(b), part(x);
      for (unsigned int i = 0; i < rhs.block(0).locally_owned_size(); ++i)
        rhs.block(0).begin()[i] += amount * (1. + i % 3);
      x    = 0.;
      part = 0.;
      rest = rhs;
      shared.reduce(x, rest);
      n_applied = 0;
      const KrylovResult of =
        solve_by_flexible_gmres(M, P, rest, part, 1e-12 * b.l2_norm(), 1000, 160, &shared);
      x += part;
      M(r, x);
      r -= rhs;
      solved = solved && of.converged && r.l2_norm() < 1e-11 * b.l2_norm();
      iterations.push_back(of.iterations);
    }
    say("further ones are solved beside what is shared", solved);
    say("in fewer iterations, and none where nothing is new",
        iterations[1] < iterations[0] && iterations[2] == 0 && shared.is_full());
    const KrylovResult restarted = solve(6);
    say("solved by six directions, in more iterations",
        restarted.converged && error() < 1e-11 && restarted.iterations > whole.iterations);
  }

  void solve_diagonals(const NodeRange &nodes)
  {
    System              system(nodes);
    const BlockOperator five  = diagonal([](const unsigned int row) { return 1. + row % 5; });
    const BlockOperator same  = diagonal([](unsigned int) { return 1.; });
    const BlockOperator twice = diagonal([](unsigned int) { return 2.; });
    la::BlockVector    &x     = system.x;
    const double        size  = system.b.l2_norm();
    const auto solve = [&](const BlockOperator &M, const double tolerance, const unsigned int limit) {
      return solve_by_flexible_gmres(M, same, system.b, x, tolerance * size, limit, 30);
    };

    x                       = 0.;
    const KrylovResult done = solve(five, 1e-10, 100);
    say("five values, five iterations", done.converged && done.iterations == 5);
    say("and to the tolerance", system.residual(five) <= 1e-10 * size);
    const KrylovResult none = solve(five, 1e-9, 100);
    say("from the solution none", none.converged && none.iterations == 0);

    x                          = 0.;
    const KrylovResult stopped = solve(five, 1e-10, 4);
    say("four are not enough", !stopped.converged && stopped.iterations == 4);
    const double       left = system.residual(five);
    const KrylovResult on   = solve(five, 1e-10, 5);
    say("and a start", on.converged && on.iterations == 5);
    x = 0.;
    solve(five, 1e-10, 3);
    say("and better than three", left < system.residual(five) && system.residual(five) < size);

    x                        = 0.;
    const KrylovResult lucky = solve(twice, 1e-10, 100);
    say("in the first direction",
        lucky.converged && lucky.iterations == 1 && system.residual(twice) < 1e-15 * size);
  }

  void solve_nothing(const NodeRange &nodes)
  {
    System       system(nodes);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    system.x         = 1.;
    for (const double of : {0., nan})
    {
      const BlockOperator   M = diagonal([of](unsigned int) { return of; });
      const BlockOperator   P = diagonal([](unsigned int) { return 1.; });
      const la::BlockVector before(system.x);
      const KrylovResult    no = solve_by_flexible_gmres(M, P, system.b, system.x, 1e-6, 100, 30);
      say(of == 0. ? "zeros fail" : "what is no number fails", !no.converged && same_bits(before, system.x));
    }
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const unsigned int rank = this_mpi_process(MPI_COMM_WORLD), ranks = n_mpi_processes(MPI_COMM_WORLD);
  if (rank > 0)
    std::cout.setstate(std::ios::failbit);
  const NodeRange nodes{n * rank / ranks, n * (rank + 1) / ranks, n};
  solve_ring(nodes);
  solve_diagonals(nodes);
  solve_nothing(nodes);
}
