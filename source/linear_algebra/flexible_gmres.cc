// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/linear_algebra/flexible_gmres.h>

// The one file that knows Belos, whose headers take long to compile, and need this one before them.
#include <Teuchos_SerialDenseMatrix.hpp>

#include <BelosBlockFGmresIter.hpp>
#include <BelosEpetraAdapter.hpp>
#include <BelosICGSOrthoManager.hpp>
#include <BelosLinearProblem.hpp>
#include <BelosOutputManager.hpp>
#include <BelosStatusTestCombo.hpp>
#include <BelosStatusTestGenResNorm.hpp>
#include <BelosStatusTestMaxIters.hpp>
#include <Epetra_Map.h>
#include <Epetra_MultiVector.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace retroforge
{
  namespace
  {
    using Directions = Epetra_MultiVector; ///< entries of a rank's blocks, one block after the other
    using Dense      = Teuchos::SerialDenseMatrix<int, double>;

    /// Passes of classical Gram-Schmidt. With one, directions are less and less orthogonal, and derivatives are
    /// up to ten times less exact than their tolerance asks for.
    constexpr int passes = 2;

    void copy(const la::BlockVector &x, Epetra_MultiVector &y)
    {
      double *to = y[0];
      for (unsigned int b = 0; b < x.n_blocks(); ++b)
        to = std::copy(x.block(b).begin(), x.block(b).end(), to);
    }

    void copy(const Epetra_MultiVector &x, la::BlockVector &y)
    {
      const double *from = x[0];
      for (unsigned int b = 0; b < y.n_blocks(); ++b)
      {
        const unsigned int n = y.block(b).locally_owned_size();
        std::copy(from, from + n, y.block(b).begin());
        from += n;
      }
    }

    Epetra_Map map_of_blocks(const la::BlockVector &x)
    {
      unsigned int n = 0;
      for (unsigned int b = 0; b < x.n_blocks(); ++b)
        n += x.block(b).locally_owned_size();
      return {-1, static_cast<int>(n), 0, x.block(0).trilinos_vector().Comm()};
    }

    /// A function of block vectors, as Belos calls it.
    struct Operator
    {
      const BlockOperator    &of;
      mutable la::BlockVector x, y;

      Operator(const BlockOperator &of, const la::BlockVector &like) : of(of), x(like), y(like) {}
    };
  } // namespace
} // namespace retroforge

namespace Belos
{
  template <>
  class OperatorTraits<double, retroforge::Directions, retroforge::Operator>
  {
  public:
    static void Apply(const retroforge::Operator   &F,
                      const retroforge::Directions &x,
                      retroforge::Directions       &y,
                      ETrans = NOTRANS)
    {
      retroforge::copy(x, F.x);
      F.of(F.y, F.x);
      retroforge::copy(F.y, y);
    }
    static bool HasApplyTranspose(const retroforge::Operator &) { return false; }
  };
} // namespace Belos

namespace retroforge
{
  namespace
  {
    using Vectors = Belos::MultiVecTraits<double, Directions>;
    using Problem = Belos::LinearProblem<double, Directions, Operator>;
    using Gmres   = Belos::BlockFGmresIter<double, Directions, Operator>;
    using Basis   = Belos::ICGSOrthoManager<double, Directions, Operator>;
    using Norm    = Belos::StatusTestGenResNorm<double, Directions, Operator>;
    using Limit   = Belos::StatusTestMaxIters<double, Directions, Operator>;
    using Either  = Belos::StatusTestCombo<double, Directions, Operator>;

    using Teuchos::rcp;

    /// Iterates until there is no more room or a test is passed, and returns the number of directions.
    int iterate(Gmres &gmres)
    {
      try
      {
        gmres.iterate();
      }
      catch (const Belos::GmresIterationOrthoFailure &)
      {
        // Nothing is left of the next direction: the solution lies in those that are there. Belos has not
        // counted the last one.
        const int n = gmres.getCurSubspaceDim();
        gmres.updateLSQR(n);
        return n + 1;
      }
      catch (const Belos::StatusTestError &)
      {
        // The residual is not a number.
      }
      return gmres.getCurSubspaceDim();
    }

    /// x += Z y with the least residual, which it returns; x is unchanged where that is not a number.
    double
    add_directions(const Belos::GmresIterationState<double, Directions> &state, const int n, Directions &x)
    {
      const double residual = std::abs((*state.z)(n, 0));
      if (n == 0)
        return residual;
      Dense y(Teuchos::Copy, *state.z, n, 1);
      Teuchos::BLAS<int, double>().TRSM(Teuchos::LEFT_SIDE,
                                        Teuchos::UPPER_TRI,
                                        Teuchos::NO_TRANS,
                                        Teuchos::NON_UNIT_DIAG,
                                        n,
                                        1,
                                        1.,
                                        state.H->values(),
                                        state.H->stride(),
                                        y.values(),
                                        y.stride());
      if (!std::isfinite(residual + y.normOne()))
        return std::numeric_limits<double>::quiet_NaN();
      std::vector<int> numbers(n);
      std::iota(numbers.begin(), numbers.end(), 0);
      Vectors::MvTimesMatAddMv(1., *Vectors::CloneView(*state.Z, numbers), y, 1., x);
      return residual;
    }
  } // namespace

  KrylovResult solve_by_flexible_gmres(const BlockOperator   &M,
                                       const BlockOperator   &P,
                                       const la::BlockVector &b,
                                       la::BlockVector       &x,
                                       const double           tolerance,
                                       const unsigned int     limit,
                                       const unsigned int     restart)
  {
    const Epetra_Map map = map_of_blocks(b);
    const auto       X = rcp(new Directions(map, 1, false)), B = rcp(new Directions(map, 1, false));
    copy(x, *X);
    copy(b, *B);
    const auto problem = rcp(new Problem(rcp(new Operator(M, b)), X, B));
    problem->setRightPrec(rcp(new Operator(P, b)));
    problem->setProblem();
    problem->setLSIndex({0});

    const auto norm = rcp(new Norm(tolerance));
    norm->defineResForm(Norm::Implicit, Belos::TwoNorm);
    norm->defineScaleForm(Belos::None, Belos::TwoNorm);
    Teuchos::ParameterList list;
    list.set("Num Blocks", std::min<int>(std::min(restart, limit), map.NumGlobalElements()));
    Gmres gmres(problem,
                rcp(new Belos::OutputManager<double>(Belos::Errors)),
                rcp(new Either(Either::OR, rcp(new Limit(limit)), norm)),
                rcp(new Basis("Belos", Teuchos::null, passes)),
                list);

    KrylovResult                                   result;
    Belos::GmresIterationState<double, Directions> first;
    const auto                                     r = Vectors::CloneCopy(*problem->getInitResVec());
    const auto                                     z = rcp(new Dense(1, 1));
    first.V                                          = r;
    first.z                                          = z;
    double residual;
    r->Norm2(&residual);
    while (residual > tolerance && result.iterations < limit)
    {
      r->Scale(1. / residual);
      (*z)(0, 0) = residual;
      gmres.initializeGmres(first);
      const int n       = iterate(gmres);
      residual          = add_directions(gmres.getState(), n, *X);
      result.iterations = gmres.getNumIters();
      if (residual > tolerance)
      {
        problem->computeCurrResVec(r.get());
        r->Norm2(&residual);
      }
    }
    copy(*X, x);
    result.converged = residual <= tolerance;
    return result;
  }
} // namespace retroforge
