// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/solver/linear_system.h>

namespace retroforge
{
  LinearSystem::LinearSystem(const Scene &scene, const LinearSolverParameters &parameters, Timings &timings)
      : timings_(timings), matrix_(scene), solver_(matrix_.system(), parameters, timings)
  {
  }

  void LinearSystem::assemble(const Equilibrium<double> &stage,
                              const Field<double>       &W,
                              const ActiveChoice        &active,
                              const Linearisation        linearisation)
  {
    const auto timing = timings_.scope("assembly");
    matrix_.assemble(stage, W, active, linearisation);
  }

  unsigned int LinearSystem::solve(const Field<double>              &rhs,
                                   const double                      tolerance,
                                   Field<double>                    &solution,
                                   const std::vector<Field<double>> &guesses,
                                   const Transposition               transposition)
  {
    la::BlockVector b = matrix_.vector(), x = matrix_.vector();
    matrix_.load(rhs, transposition, b);
    const unsigned int iterations =
      solver_.solve(b, tolerance, starts_from(guesses, transposition), transposition, x);
    matrix_.unload(x, rhs, transposition, solution);
    ++n_solves;
    return iterations;
  }

  unsigned int LinearSystem::solve_derivative(const Field<double>              &rhs,
                                              const double                      tolerance,
                                              Field<double>                    &solution,
                                              const std::vector<Field<double>> &guesses,
                                              const Transposition               transposition)
  {
    SharedTolerance own{tolerance};
    return solve_derivative(rhs, own, solution, guesses, transposition);
  }

  unsigned int LinearSystem::solve_derivative(const Field<double>              &rhs,
                                              SharedTolerance                  &tolerance,
                                              Field<double>                    &solution,
                                              const std::vector<Field<double>> &guesses,
                                              const Transposition               transposition,
                                              KrylovSpace                      *shared)
  {
    la::BlockVector b = matrix_.vector(), x = matrix_.vector();
    matrix_.load(rhs, transposition, b);
    const unsigned int iterations = solver_.solve_penalised_first(
      b, tolerance, starts_from(guesses, transposition), transposition, x, shared);
    matrix_.unload(x, rhs, transposition, solution);
    ++n_solves;
    return iterations;
  }

  std::vector<la::BlockVector> LinearSystem::starts_from(const std::vector<Field<double>> &guesses,
                                                         const Transposition transposition) const
  {
    std::vector<la::BlockVector> starts;
    for (const Field<double> &guess : guesses)
    {
      starts.push_back(matrix_.vector());
      matrix_.load_guess(guess, transposition, starts.back());
    }
    return starts;
  }
} // namespace retroforge
