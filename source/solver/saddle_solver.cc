// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/enum_setting.h>
#include <retroforge/core/error.h>
#include <retroforge/core/setting_tags.h>
#include <retroforge/core/text.h>
#include <retroforge/linear_algebra/direct_solver.h>
#include <retroforge/linear_algebra/flexible_gmres.h>
#include <retroforge/solver/penalised_rows.h>
#include <retroforge/solver/saddle_solver.h>

namespace retroforge
{
  using namespace dealii;

  namespace
  {
    /// A preconditioner is made anew when a solve with it takes `patience` times the iterations that it took
    /// when it was new, and so many more; and for the next solve from `aged` times on.
    constexpr double patience = 2.5, spare_iterations = 10., aged = 1.7;

    using Method = LinearSolverParameters::Method;

    const EnumWords<Method> method_words = {{"auto", Method::automatic},
                                            {"ilu", Method::ilu},
                                            {"multigrid", Method::multigrid},
                                            {"direct", Method::direct}};

    /// r -= M x  in some rows, by local number.
    /// @param of  the entries of M
    void subtract_product(const NodeMatrix                &of,
                          const la::SparseMatrix          &M,
                          const std::vector<unsigned int> &rows,
                          const la::Vector                &x,
                          std::vector<double>             &r)
    {
      const Epetra_Import                *importer = M.trilinos_matrix().Importer();
      std::unique_ptr<Epetra_MultiVector> met; // x in the columns of M, with those of other ranks
      if (importer != nullptr)
      {
        met = std::make_unique<Epetra_MultiVector>(M.trilinos_matrix().ColMap(), 1, false);
        met->Import(x.trilinos_vector(), *importer, Insert);
      }
      const double *values = met ? (*met)[0] : x.begin();
      for (const unsigned int i : rows)
      {
        const NodeMatrix::Row row = of.row(i);
        double                sum = 0.;
        for (unsigned int e = 0; e < row.n; ++e)
          sum += row.values[e] * values[row.columns[e]];
        r[i] -= sum;
      }
    }

    /// b - M x  in penalised rows of A, by local rows; b in others.
    std::vector<double>
    penalised_residual(const SaddleSystem &system, const la::BlockVector &b, const la::BlockVector &x)
    {
      const la::BlockSparseMatrix &M = system.matrix;
      std::vector<double>          r(b.block(0).begin(), b.block(0).end());
      subtract_product(*system.A, M.block(0, 0), system.penalised, x.block(0), r);
      subtract_product(*system.B, M.block(0, 1), system.penalised, x.block(1), r);
      for (const auto &[row, column] : system.held)
      {
        const double weight = column * x.block(0);
        for (const unsigned int i : system.penalised)
          r[i] -= weight * row.begin()[i];
      }
      return r;
    }
  } // namespace

  void LinearSolverParameters::add_parameters(ParameterHandler &prm)
  {
    prm.enter_subsection("Linear solver");
    add_enum(
      prm,
      "method",
      method,
      method_words,
      "auto takes `multigrid` on large meshes and for quadratic velocities, else `ilu`, and falls back to "
      "`direct` when they fail. Units: none.");
    prm.add_parameter(
      "multigrid from",
      multigrid_from,
      "Number of nodes from which `auto` takes multigrid where velocities are linear. Units: none.");
    prm.add_parameter("max iterations",
                      max_iterations,
                      "Krylov iterations after which the direct solver takes over. Units: none.",
                      Patterns::Integer(1));
    prm.add_parameter("restart", restart, "Krylov vectors kept. Units: none.", Patterns::Integer(5, 1000));
    prm.leave_subsection();
    tag(prm, "Linear solver", SettingRole::numerics);
  }

  double SharedTolerance::next(const double norm)
  {
    constexpr double loosest = 1e-2;
    largest                  = std::max(largest, norm);
    return norm == 0. ? tolerance : std::max(tolerance, std::min(loosest, tolerance * largest / norm));
  }

  SaddleSolver::SaddleSolver(const SaddleSystem           &system,
                             const LinearSolverParameters &parameters,
                             Timings                      &timings)
      : system_(system), parameters_(parameters), timings_(timings)
  {
  }

  SaddleSolver::Blocks::Blocks(const la::BlockSparseMatrix &matrix)
      : A(matrix.block(0, 0), 3, 3)
      , B(matrix.block(0, 1), 3, 1)
      , D(matrix.block(1, 0), 1, 3)
      , C(matrix.block(1, 1), 1, 1)
  {
  }

  void SaddleSolver::Blocks::update()
  {
    for (BlockedMatrix *block : {&A, &B, &D, &C})
      block->update();
  }

  unsigned int SaddleSolver::solve(const la::BlockVector              &b,
                                   const double                        tolerance,
                                   const std::vector<la::BlockVector> &guesses,
                                   const Transposition                 asked,
                                   la::BlockVector                    &x,
                                   KrylovSpace                        *shared)
  {
    const Transposition transposition = simplest(asked);
    x                                 = 0.;
    if (parameters_.method != Method::direct)
      return solve_iteratively(b, tolerance, guesses, transposition, x, shared);
    solve_directly(b, transposition, x);
    return 0;
  }

  unsigned int SaddleSolver::solve_penalised_first(const la::BlockVector       &b,
                                                   SharedTolerance             &tolerance,
                                                   std::vector<la::BlockVector> guesses,
                                                   const Transposition          asked,
                                                   la::BlockVector             &x,
                                                   KrylovSpace                 *shared)
  {
    const Transposition transposition = simplest(asked);
    if (parameters_.method == Method::direct)
      return solve(b, tolerance.tolerance, guesses, transposition, x);
    la::BlockVector       first(x), nothing(b);
    const la::BlockVector rest = take_penalised(b, transposition, first);
    nothing                    = 0.;
    for (la::BlockVector &guess : guesses)
      polish_penalised(nothing, transposition, guess);
    const unsigned int iterations =
      solve(rest, tolerance.next(rest.l2_norm()), guesses, transposition, x, shared);
    x += first;
    polish_penalised(b, transposition, x);
    return iterations;
  }

  la::BlockVector SaddleSolver::take_penalised(const la::BlockVector &b,
                                               const Transposition    transposition,
                                               la::BlockVector       &x) const
  {
    x = 0.;
    polish_penalised(b, transposition, x);
    return residual(b, transposition, x);
  }

  la::BlockVector SaddleSolver::residual(const la::BlockVector &b,
                                         const Transposition    transposition,
                                         const la::BlockVector &x) const
  {
    la::BlockVector r(x);
    if (transposition == Transposition::plain)
      system_.matrix.residual(r, x, b);
    else
    {
      system_.matrix.Tvmult(r, x);
      r.sadd(-1., 1., b);
    }
    add_held(-1., transposition, r, x);
    return r;
  }

  la::BlockVector SaddleSolver::start_from(const std::vector<la::BlockVector> &guesses,
                                           const la::BlockVector              &b,
                                           const Transposition                 transposition,
                                           la::BlockVector                    &x) const
  {
    la::BlockVector              r = b;
    std::vector<la::BlockVector> images, sources;
    for (const la::BlockVector &guess : guesses)
    {
      la::BlockVector source(guess), y(x);
      multiply(transposition, y, source);
      const double whole = y.l2_norm();
      for (std::size_t j = 0; j < images.size(); ++j)
      {
        const double c = y * images[j];
        y.add(-c, images[j]);
        source.add(-c, sources[j]);
      }
      const double norm = y.l2_norm();
      if (!(norm > 1e-8 * whole))
        continue;
      y *= 1. / norm;
      source *= 1. / norm;
      const double c = y * r;
      r.add(-c, y);
      x.add(c, source);
      images.push_back(y);
      sources.push_back(source);
    }
    return r;
  }

  void SaddleSolver::multiply(const Transposition    transposition,
                              la::BlockVector       &y,
                              const la::BlockVector &x) const
  {
    if (transposition == Transposition::transposed)
    {
      system_.matrix.Tvmult(y, x);
      add_held(1., transposition, y, x);
      return;
    }
    blocks_->A.vmult(y.block(0), x.block(0));
    blocks_->B.vmult_add(y.block(0), x.block(1));
    blocks_->D.vmult(y.block(1), x.block(0));
    blocks_->C.vmult_add(y.block(1), x.block(1));
    add_held(1., transposition, y, x);
  }

  void SaddleSolver::add_held(const double           factor,
                              const Transposition    transposition,
                              la::BlockVector       &y,
                              const la::BlockVector &x) const
  {
    for (const auto &[row, column] : system_.held)
      if (transposition == Transposition::plain)
        y.block(0).add(factor * (column * x.block(0)), row);
      else
        y.block(0).add(factor * (row * x.block(0)), column);
  }

  void SaddleSolver::make_preconditioner()
  {
    const auto timing = timings_.scope("preconditioner");
    const bool large  = system_.P || system_.A->pattern().rows().n >= parameters_.multigrid_from;
    const bool multigrid =
      parameters_.method == Method::multigrid || (parameters_.method == Method::automatic && large);
    preconditioner_ = std::make_unique<Preconditioner>(blocks_->A,
                                                       blocks_->B,
                                                       system_.matrix.block(1, 0),
                                                       system_.schur,
                                                       multigrid,
                                                       system_.translations,
                                                       system_.P ? &system_.interpolation : nullptr);
    first_rate_     = 0.;
  }

  void SaddleSolver::polish_penalised(const la::BlockVector &b,
                                      const Transposition    transposition,
                                      la::BlockVector       &x) const
  {
    if (transposition == Transposition::plain)
      solve_penalised_rows(
        system_, transposition, penalised_residual(system_, b, x).data(), x.block(0).begin());
    else
      solve_penalised_rows(
        system_, transposition, residual(b, transposition, x).block(0).begin(), x.block(0).begin());
  }

  unsigned int SaddleSolver::solve_iteratively(const la::BlockVector              &b,
                                               const double                        tolerance,
                                               const std::vector<la::BlockVector> &guesses,
                                               const Transposition                 transposition,
                                               la::BlockVector                    &x,
                                               KrylovSpace                        *shared)
  {
    const double norm = b.l2_norm();
    if (norm == 0.)
      return 0;
    if (blocks_)
      blocks_->update();
    else
      blocks_ = std::make_unique<Blocks>(system_.matrix);
    la::BlockVector r        = start_from(guesses, b, transposition, x);
    const bool      deflated = shared && !shared->empty();
    if (deflated)
      shared->reduce(x, r);
    const double start = r.l2_norm();
    if (start <= tolerance * norm)
      return 0;
    const double decades = std::max(0.5, std::log10(start / (tolerance * norm)));
    unsigned int total   = 0;
    for (unsigned int attempt = 0; attempt < 2; ++attempt)
    {
      const bool fresh = !preconditioner_;
      if (fresh)
        make_preconditioner();
      const unsigned int limit =
        first_rate_ == 0. ? parameters_.max_iterations
                          : std::min<unsigned int>(parameters_.max_iterations,
                                                   patience * first_rate_ * decades + spare_iterations);
      const KrylovResult krylov =
        iterate(b, r, tolerance * norm, limit, transposition, x, attempt == 0 ? shared : nullptr);
      total += krylov.iterations;
      if (krylov.converged)
      {
        polish_penalised(b, transposition, x);
        const double rate = krylov.iterations / decades;
        if (deflated)
          return total; // what it took says little about others
        if (first_rate_ == 0.)
          first_rate_ = rate;
        else if (rate > aged * first_rate_ + 1.)
          reset();
        return total;
      }
      reset();
      if (fresh)
        break;
    }
    if (parameters_.method != Method::automatic)
      throw Error("Linear solver/method",
                  "'" + word_of(parameters_.method, method_words) + "' did not reach " + as_text(tolerance) +
                    " in " + std::to_string(parameters_.max_iterations) + " iterations",
                  "the linear system must be solved",
                  "use 'auto', which falls back to the direct solver, or check that the billet cannot slide "
                  "or spin freely");
    solve_directly(b, transposition, x);
    return total;
  }

  KrylovResult SaddleSolver::iterate(const la::BlockVector &b,
                                     la::BlockVector       &r,
                                     const double           tolerance,
                                     const unsigned int     limit,
                                     const Transposition    transposition,
                                     la::BlockVector       &x,
                                     KrylovSpace           *shared) const
  {
    const auto timing = timings_.scope("krylov");
    const auto P      = [&](la::BlockVector &z, const la::BlockVector &y) {
      if (transposition == Transposition::plain)
        preconditioner_->vmult(z, y);
      else
        preconditioner_->Tvmult(z, y);
    };
    const auto M = [&](la::BlockVector &y, const la::BlockVector &v) { multiply(transposition, y, v); };
    if (!shared || shared->empty())
      return solve_by_flexible_gmres(M, P, b, x, tolerance, limit, parameters_.restart, shared);
    la::BlockVector dx(x);
    dx = 0.;
    const KrylovResult krylov =
      solve_by_flexible_gmres(M, P, r, dx, tolerance, limit, parameters_.restart, shared);
    x += dx;
    return krylov;
  }

  void SaddleSolver::solve_directly(const la::BlockVector &b,
                                    const Transposition    transposition,
                                    la::BlockVector       &x) const
  {
    const auto timing = timings_.scope("direct solver");
    solve_by_mumps(system_.matrix, b, x, transposition, system_.held);
  }
} // namespace retroforge
