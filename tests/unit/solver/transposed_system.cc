// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The saddle point system of the corner of a billet, made unsymmetric on purpose: entries of A on one side of
// the diagonal grow by a tenth, those of D by a fifth. Proved, on one rank and on two, for linear and for
// quadratic velocities, for the plain and the transposed system, solved directly, by multigrid, and where
// velocities are linear by incomplete factors:
// - the residual, formed with the matrix or its transpose, vanishes;
// - <y, M^-1 b> = <M^-T y, b>;
// - the two have different solutions, so that one does not stand in for the other;
// - of a matrix that is said to be symmetric, the plain system is solved, to the bit.

#include <deal.II/base/mpi.h>

#include <retroforge/solver/saddle_solver.h>

#include "corner_stage.h"
#include "methods.h"

using namespace retroforge;

namespace
{
  la::BlockVector random_vector(const SaddleMatrix &matrix, const unsigned int seed)
  {
    la::BlockVector b = matrix.vector();
    for (unsigned int block = 0; block < 2; ++block)
      for (const auto i : b.block(block).locally_owned_elements())
        b.block(block)[i] = std::sin(1. + i + 17. * block + 0.37 * seed * i);
    b.compress(dealii::VectorOperation::insert);
    return b;
  }

  /// A copy of a system with unsymmetric entries.
  std::unique_ptr<SaddleSystem> made_unsymmetric(const SaddleSystem &from)
  {
    auto       to   = std::make_unique<SaddleSystem>();
    const auto copy = [&](const NodeMatrix  &source,
                          la::SparseMatrix  &matrix,
                          const unsigned int rows,
                          const unsigned int columns,
                          const double       upper) {
      const auto pattern = std::make_shared<const NodePattern>(source.pattern());
      auto       view    = std::make_unique<NodeMatrix>(matrix, pattern, rows, columns, MPI_COMM_WORLD);
      for (unsigned int i = 0; i < view->n_rows(); ++i)
        for (unsigned int e = 0; e < view->row(i).n; ++e)
        {
          const unsigned int row   = rows * pattern->rows().begin + i;
          const bool         above = view->column(view->row(i).columns[e]) > row;
          view->row(i).values[e]   = (rows != columns || above ? upper : 1.) * source.row(i).values[e];
        }
      return view;
    };
    to->matrix.reinit(2, 2);
    to->A = copy(*from.A, to->matrix.block(0, 0), 3, 3, 1.1);
    to->B = copy(*from.B, to->matrix.block(0, 1), 3, 1, 1.);
    to->D = copy(*from.D, to->matrix.block(1, 0), 1, 3, 1.2);
    to->C = copy(*from.C, to->matrix.block(1, 1), 1, 1, 1.);
    to->S = copy(*from.S, to->schur, 1, 1, 1.);
    to->matrix.collect_sizes();
    if (from.P)
      to->P = copy(*from.P, to->interpolation, 3, 3, 1.);
    to->symmetric    = false;
    to->translations = from.translations;
    return to;
  }

  /// Solves for b with either matrix.
  struct Pair
  {
    Timings                timings;
    LinearSolverParameters parameters;
    const SaddleSystem    &system;
    la::BlockVector        plain, transposed;

    Pair(const SaddleSystem &system, const std::string &method, const la::BlockVector &b)
        : system(system), plain(b), transposed(b)
    {
      parameters.method         = method_of(method);
      parameters.max_iterations = 2000;
      SaddleSolver solver(system, parameters, timings);
      solver.solve(b, 1e-12, {}, Transposition::plain, plain);
      solver.solve(b, 1e-12, {}, Transposition::transposed, transposed);
    }
  };

  double difference(const la::BlockVector &x, const la::BlockVector &y)
  {
    la::BlockVector d(x);
    d.add(-1., y);
    return d.l2_norm() / y.l2_norm();
  }

  void check(const SaddleMatrix &matrix, const std::string &method, Errors &errors)
  {
    const auto            system = made_unsymmetric(matrix.system());
    const la::BlockVector b = random_vector(matrix, 1), y = random_vector(matrix, 2);
    const Pair            of_b(*system, method, b), of_y(*system, method, y);
    la::BlockVector       image(b);
    system->matrix.vmult(image, of_b.plain);
    errors.compare(method + ": M x = b", difference(image, b), 0.);
    system->matrix.Tvmult(image, of_b.transposed);
    errors.compare(method + ": M^T x = b", difference(image, b), 0.);
    // Of vectors that happen to be nearly orthogonal the product is small, its error is not.
    errors.compare(method + ": <y, M^-1 b> = <M^-T y, b>",
                   (y * of_b.plain - of_y.transposed * b) / (y.l2_norm() * of_b.plain.l2_norm()),
                   0.);
    const double other = difference(of_b.plain, of_b.transposed);
    std::cout << "  " << method << ", two solutions: " << (other > 0.01 ? "yes" : "NO") << "\n";
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
    std::cout.setstate(std::ios::failbit);
  for (const ElementPair pair : {ElementPair::mini, ElementPair::taylor_hood})
  {
    const bool linear = pair == ElementPair::mini;
    std::cout << (linear ? "linear" : "quadratic") << " velocities\n";
    Random       random;
    CornerStage  corner(random, 2., pair);
    SaddleMatrix matrix(corner.scene);
    matrix.assemble(corner.stage(), corner.W, corner.active, Linearisation::newton);
    Errors errors;
    // Incomplete factors are no match for quadratic velocities.
    for (const std::string method : {"direct", "ilu", "multigrid"})
      if (linear || method != "ilu")
        check(matrix, method, errors);
    errors.print(1e-10);
    const Pair symmetric(matrix.system(), "auto", random_vector(matrix, 1));
    std::cout << "  symmetric, the same bits: "
              << (difference(symmetric.plain, symmetric.transposed) == 0. ? "yes" : "NO") << "\n";
  }
}
