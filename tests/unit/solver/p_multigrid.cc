// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Multigrid for quadratic velocities: the corner of a billet that stiff penalties press against a wavy die
// and a tilted plane. Proved, on one rank and on two:
// - a linear velocity, given at the vertices in the axes and scales of their unknowns, is interpolated to the
//   unknowns of the middles exactly; middles that a die holds take no part, and there are such;
// - the unknowns of the vertices come first among a rank's;
// - the solution is that of the direct solver, and has the same bits again;
// - a mesh with nine times as many cells takes hardly more iterations, fewer than 40.

#include <deal.II/base/mpi.h>

#include <retroforge/solver/saddle_solver.h>

#include "corner_stage.h"
#include "methods.h"

using namespace retroforge;
using dealii::Utilities::MPI::sum;

namespace
{
  struct Corner : CornerStage
  {
    SaddleMatrix matrix;

    Corner(Random &random, const std::array<unsigned int, 3> &cells)
        : CornerStage(random, 1e4, ElementPair::taylor_hood, cells), matrix(scene)
    {
      W = linear_velocity();
      active.assign(contact.pairs.size(), 1);
      matrix.assemble(stage(), W, active, Linearisation::newton);
    }

    /// At rest in the plane of symmetry, and without divergence.
    Field<double> linear_velocity() const
    {
      NodalVectors<double> V(scene.mesh.n_nodes());
      for (NodeIndex k = 0; k < V.size(); ++k)
      {
        const Vec3 &x = scene.mesh.X[k];
        V[k]          = Vec3({0.5 * x[0], 0.2 + 0.1 * x[0] + 0.3 * x[1], 0.1 * x[1] - 0.8 * x[2]});
      }
      return interpolated(scene.discretization, V, std::vector<double>(V.size(), 0.));
    }
  };

  void check_interpolation(const Corner &corner, Errors &errors)
  {
    const SaddleSystem &system = corner.matrix.system();
    la::BlockVector     x      = corner.matrix.vector();
    corner.matrix.load_guess(corner.linear_velocity(), Transposition::plain, x);
    la::Vector   at_vertices(system.interpolation.locally_owned_domain_indices(), MPI_COMM_WORLD);
    la::Vector   found(x.block(0));
    const double n_vertices = at_vertices.locally_owned_size(), *expected = x.block(0).begin();
    std::copy(expected, expected + at_vertices.locally_owned_size(), at_vertices.begin());
    system.interpolation.vmult(found, at_vertices);
    unsigned int n_held = 0, n_taking_part = 0;
    for (const unsigned int row : system.penalised)
      if (row >= n_vertices)
      {
        ++n_held;
        n_taking_part += found.begin()[row] != 0.;
        found.begin()[row] = expected[row];
      }
    found -= x.block(0);
    errors.compare("interpolated", found.linfty_norm() / x.block(0).linfty_norm(), 0.);
    std::cout << "held middles take no part: "
              << (sum(n_held, MPI_COMM_WORLD) > 10 && sum(n_taking_part, MPI_COMM_WORLD) == 0 ? "yes" : "NO")
              << "\n";
  }

  la::BlockVector right_hand_side(const SaddleMatrix &matrix)
  {
    la::BlockVector b = matrix.vector();
    for (unsigned int block = 0; block < 2; ++block)
      for (const auto i : b.block(block).locally_owned_elements())
        b.block(block)[i] = std::sin(1. + 17. * block + 0.37 * i * i);
    b.compress(dealii::VectorOperation::insert);
    return b;
  }

  unsigned int
  solve(const Corner &corner, const std::string &method, const double tolerance, la::BlockVector &x)
  {
    Timings                timings;
    LinearSolverParameters parameters;
    parameters.method = method_of(method);
    SaddleSolver solver(corner.matrix.system(), parameters, timings);
    return solver.solve(right_hand_side(corner.matrix), tolerance, {}, Transposition::plain, x);
  }

  double difference(la::BlockVector x, const la::BlockVector &y)
  {
    x -= y;
    return x.l2_norm() / y.l2_norm();
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
    std::cout.setstate(std::ios::failbit);
  Errors                    errors;
  std::vector<unsigned int> iterations;
  for (const std::array<unsigned int, 3> cells :
       {std::array<unsigned int, 3>{{4, 6, 4}}, {{6, 8, 6}}, {{8, 12, 9}}})
  {
    Random          random;
    const Corner    corner(random, cells);
    la::BlockVector x = corner.matrix.vector(), exact(x), again(x);
    iterations.push_back(solve(corner, "auto", 1e-8, x));
    if (iterations.size() > 1)
      continue;
    check_interpolation(corner, errors);
    solve(corner, "multigrid", 1e-13, x);
    solve(corner, "auto", 1e-13, again);
    solve(corner, "direct", 0., exact);
    errors.compare("as solved directly", difference(x, exact), 0.);
    std::cout << "the same bits: " << (difference(x, again) == 0. ? "yes" : "NO") << "\n";
  }
  errors.print(1e-10);
  std::cout << "fewer than 40 iterations: " << (iterations.back() < 40 ? "yes" : "NO")
            << "\nhardly more on the finest mesh: "
            << (iterations.back() < 1.3 * iterations.front() ? "yes" : "NO") << "\n";
}
