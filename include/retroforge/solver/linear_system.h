// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/saddle_solver.h>

namespace retroforge
{
  /// The linear systems of a stage: its Newton matrix, and solutions for right-hand sides that are fields.
  class LinearSystem
  {
  public:
    LinearSystem(const Scene &scene, const LinearSolverParameters &parameters, Timings &timings);

    /// Matrix of `stage` at W; velocities fixed by symmetry are eliminated.
    void assemble(const Equilibrium<double> &stage,
                  const Field<double>       &W,
                  const ActiveChoice        &active,
                  Linearisation              linearisation = Linearisation::newton);

    /// Solution of the uncondensed system, or of the transposed one, for the right-hand side rhs (owned
    /// entries), to `tolerance` relative to the scaled right-hand side. Returns the number of Krylov
    /// iterations (0 for a direct solve). A rank gets its own entries and those it reads.
    /// @param guesses  fields, as the solutions of earlier systems: their best combination is the start
    unsigned int solve(const Field<double>              &rhs,
                       double                            tolerance,
                       Field<double>                    &solution,
                       const std::vector<Field<double>> &guesses       = {},
                       Transposition                     transposition = Transposition::plain);

    /// Solves as solve() does for right-hand sides that are derivatives: of a residual, which a moving die
    /// makes large where it pushes, or of an objective, which contact forces make large there
    /// (SaddleSolver::solve_penalised_first).
    /// @param shared  what derivatives of this stage and this transposition have in common
    unsigned int solve_derivative(const Field<double>              &rhs,
                                  SharedTolerance                  &tolerance,
                                  Field<double>                    &solution,
                                  const std::vector<Field<double>> &guesses       = {},
                                  Transposition                     transposition = Transposition::plain,
                                  KrylovSpace                      *shared        = nullptr);

    /// The same of a system by itself.
    unsigned int solve_derivative(const Field<double>              &rhs,
                                  double                            tolerance,
                                  Field<double>                    &solution,
                                  const std::vector<Field<double>> &guesses       = {},
                                  Transposition                     transposition = Transposition::plain);

    /// Discards the preconditioner: the next solve makes a new one.
    void reset() { solver_.reset(); }

    /// The scaled norm in which solves and Newton converge: of a residual's momentum rows, and of its
    /// continuity rows.
    std::pair<double, double> residual_norm(const Field<double> &r) const { return matrix_.residual_norm(r); }

    unsigned int n_solves = 0;

  private:
    /// The system's vectors of fields.
    std::vector<la::BlockVector> starts_from(const std::vector<Field<double>> &guesses,
                                             Transposition                     transposition) const;

    Timings     &timings_;
    SaddleMatrix matrix_;
    SaddleSolver solver_;
  };
} // namespace retroforge
