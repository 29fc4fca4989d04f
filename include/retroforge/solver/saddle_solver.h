// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/timer.h>
#include <retroforge/linear_algebra/flexible_gmres.h>
#include <retroforge/linear_algebra/preconditioner.h>
#include <retroforge/solver/saddle_matrix.h>

namespace retroforge
{
  struct LinearSolverParameters
  {
    enum class Method
    {
      automatic, ///< multigrid or ILU by the size of the mesh; the direct solver where they fail
      ilu,
      multigrid,
      direct
    };

    Method       method         = Method::automatic;
    unsigned int multigrid_from = 2500;
    unsigned int max_iterations = 600;
    unsigned int restart        = 120;

    void add_parameters(dealii::ParameterHandler &prm);
  };

  /// How well systems are solved whose solutions are added up: to one error, relative to the largest right-hand
  /// side so far, but each to 1e-2 of its own at least.
  struct SharedTolerance
  {
    double tolerance;
    double largest = 0.; ///< norm

    /// Returns the tolerance relative to this norm of the next right-hand side.
    double next(double norm);
  };

  /// Solves saddle point systems, one after the other, to a given tolerance: by FGMRES with a preconditioner
  /// that is kept while it works, or directly.
  class SaddleSolver
  {
  public:
    /// @param system  its matrix may change between solves
    SaddleSolver(const SaddleSystem &system, const LinearSolverParameters &parameters, Timings &timings);

    /// @param tolerance  relative to b
    /// @param guesses    like the solutions of earlier systems: the best combination of them is the start
    /// @param shared     what solves with this same matrix have found, of which this one need only find the rest;
    /// empty: becomes what this one finds
    /// @return number of Krylov iterations, 0 for a direct solve
    unsigned int solve(const la::BlockVector              &b,
                       double                              tolerance,
                       const std::vector<la::BlockVector> &guesses,
                       Transposition                       transposition,
                       la::BlockVector                    &x,
                       KrylovSpace                        *shared = nullptr);

    /// Solves as solve() does for a right-hand side that is large in penalised rows, as that of the motion of
    /// a die or of an objective of contact forces. These rows, which would dwarf the others in the norm, are
    /// solved by themselves first, in the guesses too; the tolerance is relative to the norm of the remaining
    /// right-hand side.
    unsigned int solve_penalised_first(const la::BlockVector       &b,
                                       SharedTolerance             &tolerance,
                                       std::vector<la::BlockVector> guesses,
                                       Transposition                transposition,
                                       la::BlockVector             &x,
                                       KrylovSpace                 *shared = nullptr);

    /// Discards the preconditioner: the next solve makes a new one.
    void reset() { preconditioner_.reset(); }

  private:
    /// The system's blocks [A B; D C], as of the solve that goes on.
    struct Blocks
    {
      BlockedMatrix A, B, D, C;

      explicit Blocks(const la::BlockSparseMatrix &matrix);
      void update();
    };

    unsigned int solve_iteratively(const la::BlockVector              &b,
                                   double                              tolerance,
                                   const std::vector<la::BlockVector> &guesses,
                                   Transposition                       transposition,
                                   la::BlockVector                    &x,
                                   KrylovSpace                        *shared);
    /// Sets x to the combination of the guesses with the least residual, and returns that.
    la::BlockVector start_from(const std::vector<la::BlockVector> &guesses,
                               const la::BlockVector              &b,
                               Transposition                       transposition,
                               la::BlockVector                    &x) const;
    /// Iterates from x, whose residual is r, with the preconditioner that there is.
    KrylovResult iterate(const la::BlockVector &b,
                         la::BlockVector       &r,
                         double                 tolerance,
                         unsigned int           limit,
                         Transposition          transposition,
                         la::BlockVector       &x,
                         KrylovSpace           *shared) const;
    void         make_preconditioner();
    /// Sets penalised components of x, and nothing else, so that their rows have no residual, and returns
    /// what that leaves of b.
    la::BlockVector
    take_penalised(const la::BlockVector &b, Transposition transposition, la::BlockVector &x) const;
    /// b - M x, or b - M^T x.
    la::BlockVector
    residual(const la::BlockVector &b, Transposition transposition, const la::BlockVector &x) const;
    /// y = M x, or y = M^T x.
    void multiply(Transposition transposition, la::BlockVector &y, const la::BlockVector &x) const;
    /// y += factor H x, or H^T x, with what SaddleSystem::held adds to the matrix.
    void
    add_held(double factor, Transposition transposition, la::BlockVector &y, const la::BlockVector &x) const;
    /// Solves the rows of penalised components exactly, the others held: an error there that the norm hardly
    /// sees would decide which nodes a die pushes, because a contact force is the penalty times a small
    /// difference.
    void polish_penalised(const la::BlockVector &b, Transposition transposition, la::BlockVector &x) const;
    void solve_directly(const la::BlockVector &b, Transposition transposition, la::BlockVector &x) const;
    /// The one that is as good and simpler: of a symmetric matrix, the plain one.
    Transposition simplest(const Transposition transposition) const
    {
      return system_.symmetric ? Transposition::plain : transposition;
    }

    const SaddleSystem             &system_;
    const LinearSolverParameters   &parameters_;
    Timings                        &timings_;
    std::unique_ptr<Blocks>         blocks_;
    std::unique_ptr<Preconditioner> preconditioner_;
    double first_rate_ = 0.; ///< iterations per decade when it was fresh; 0: not known
  };
} // namespace retroforge
