// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/mpi.h>

#include <retroforge/linear_algebra/flexible_gmres.h>

// The one file that knows Belos, whose headers take long to compile, and need this one before them.
#include <Teuchos_SerialDenseMatrix.hpp>

#include <BelosBlockFGmresIter.hpp>
#include <BelosICGSOrthoManager.hpp>
#include <BelosLinearProblem.hpp>
#include <BelosMultiVec.hpp>
#include <BelosOperator.hpp>
#include <BelosOutputManager.hpp>
#include <BelosStatusTestCombo.hpp>
#include <BelosStatusTestGenResNorm.hpp>
#include <BelosStatusTestMaxIters.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace retroforge
{
  namespace
  {
    using Dense       = Teuchos::SerialDenseMatrix<int, double>;
    using MultiVector = Belos::MultiVec<double>;

    /// Passes of classical Gram-Schmidt. With one, directions are less and less orthogonal, and derivatives are
    /// up to ten times less exact than their tolerance asks for.
    constexpr int passes = 2;

    std::size_t n_owned(const la::BlockVector &x)
    {
      std::size_t n = 0;
      for (unsigned int b = 0; b < x.n_blocks(); ++b)
        n += x.block(b).locally_owned_size();
      return n;
    }

    /// Entries of a rank's blocks, one block after the other.
    void copy(const la::BlockVector &x, double *to)
    {
      for (unsigned int b = 0; b < x.n_blocks(); ++b)
        to = std::copy(x.block(b).begin(), x.block(b).end(), to);
    }

    void copy(const double *from, la::BlockVector &y)
    {
      for (unsigned int b = 0; b < y.n_blocks(); ++b)
      {
        const unsigned int n = y.block(b).locally_owned_size();
        std::copy(from, from + n, y.block(b).begin());
        from += n;
      }
    }

    /// Vectors of one length, one behind the other, or a view of neighbours among them. One of them is
    /// multiplied with all others as a vector with a matrix. Trilinos' own vectors do so as two matrices,
    /// which BLAS sorts into blocks first, and that takes longer than the product.
    class Directions : public MultiVector
    {
    public:
      /// Without values yet.
      /// @param length  of a vector, on all ranks
      /// @param n       entries of this one
      Directions(const MPI_Comm comm, const std::size_t length, const std::size_t n, const int n_vectors)
          : comm_(comm)
          , length_(length)
          , n_(n)
          , n_vectors_(n_vectors)
          , entries_(new double[n * n_vectors])
          , first_(entries_.get())
      {
      }

      explicit Directions(const la::BlockVector &x)
          : Directions(x.block(0).get_mpi_communicator(), x.size(), n_owned(x), 1)
      {
        copy(x, first_);
      }

      double       *operator[](const int j) { return first_ + j * n_; }
      const double *operator[](const int j) const { return first_ + j * n_; }

      MultiVector *Clone(const int n_vectors) const override
      {
        return new Directions(comm_, length_, n_, n_vectors);
      }
      MultiVector *CloneCopy() const override { return copied(*this); }
      MultiVector *CloneCopy(const std::vector<int> &which) const override { return copied(view(which)); }
      MultiVector *CloneViewNonConst(const std::vector<int> &which) override
      {
        return new Directions(view(which));
      }
      const MultiVector *CloneView(const std::vector<int> &which) const override
      {
        return new Directions(view(which));
      }
      ptrdiff_t GetGlobalLength() const override { return length_; }
      int       GetNumberVecs() const override { return n_vectors_; }

      void
      MvTimesMatAddMv(const double alpha, const MultiVector &A, const Dense &B, const double beta) override
      {
        const Directions &of = from(A);
        if (beta == 0.)
          MvInit(0.); // not every BLAS leaves alone what has no value yet
        for (int j = 0; j < n_vectors_; ++j)
          Teuchos::BLAS<int, double>().GEMV(
            Teuchos::NO_TRANS, n_, of.n_vectors_, alpha, of[0], stride(), B[j], 1, beta, (*this)[j], 1);
      }
      void MvTransMv(const double alpha, const MultiVector &A, Dense &B) const override
      {
        const Directions &of = from(A);
        B.putScalar(0.); // BLAS does nothing on a rank without entries
        for (int j = 0; j < n_vectors_; ++j)
        {
          Teuchos::BLAS<int, double>().GEMV(
            Teuchos::TRANS, n_, of.n_vectors_, alpha, of[0], stride(), (*this)[j], 1, 0., B[j], 1);
          const dealii::ArrayView<double> sums(B[j], of.n_vectors_);
          dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(sums), comm_, sums);
        }
      }
      void MvAddMv(const double alpha, const MultiVector &A, const double beta, const MultiVector &B) override
      {
        const double *a = from(A)[0], *b = from(B)[0];
        for (std::size_t i = 0; i < n_ * n_vectors_; ++i)
          first_[i] = alpha * a[i] + beta * b[i];
      }
      void MvScale(const double alpha) override
      {
        std::for_each(first_, first_ + n_ * n_vectors_, [alpha](double &x) { x *= alpha; });
      }
      void MvScale(const std::vector<double> &alpha) override
      {
        for (int j = 0; j < n_vectors_; ++j)
          std::for_each((*this)[j], (*this)[j] + n_, [&](double &x) { x *= alpha[j]; });
      }
      void MvDot(const MultiVector &A, std::vector<double> &products) const override
      {
        const Directions &of = from(A);
        for (int j = 0; j < n_vectors_; ++j)
          products[j] =
            dealii::Utilities::MPI::sum(std::inner_product((*this)[j], (*this)[j] + n_, of[j], 0.), comm_);
      }
      void MvNorm(std::vector<double> &norms, const Belos::NormType type) const override
      {
        Assert(type == Belos::TwoNorm, dealii::ExcNotImplemented());
        (void)type;
        MvDot(*this, norms);
        for (int j = 0; j < n_vectors_; ++j)
          norms[j] = std::sqrt(norms[j]);
      }
      void SetBlock(const MultiVector &A, const std::vector<int> &which) override
      {
        const Directions &of = from(A);
        for (std::size_t j = 0; j < which.size(); ++j)
          std::copy(of[j], of[j] + n_, (*this)[which[j]]);
      }
      void MvInit(const double alpha) override { std::fill(first_, first_ + n_ * n_vectors_, alpha); }
      void MvRandom() override { Assert(false, dealii::ExcNotImplemented()); }
      void MvPrint(std::ostream &) const override {}

    private:
      static const Directions &from(const MultiVector &A) { return dynamic_cast<const Directions &>(A); }
      static Directions       *copied(const Directions &from)
      {
        auto *copy = new Directions(from.comm_, from.length_, from.n_, from.n_vectors_);
        std::copy(from[0], from[from.n_vectors_], (*copy)[0]);
        return copy;
      }
      /// Shares the entries.
      Directions view(const std::vector<int> &which) const
      {
        for (std::size_t j = 1; j < which.size(); ++j)
          AssertDimension(which[j], which[0] + static_cast<int>(j));
        Directions some(*this);
        some.first_ += which[0] * n_;
        some.n_vectors_ = which.size();
        return some;
      }
      /// BLAS wants it positive on a rank without entries, too.
      int stride() const { return std::max<int>(n_, 1); }

      MPI_Comm                  comm_;
      std::size_t               length_, n_;
      int                       n_vectors_;
      std::shared_ptr<double[]> entries_;
      double                   *first_;
    };

    /// A function of block vectors, as Belos calls it.
    class AppliedOperator : public Belos::Operator<double>
    {
    public:
      AppliedOperator(const BlockOperator &of, const la::BlockVector &like) : of_(of), x_(like), y_(like) {}

      void Apply(const MultiVector &x, MultiVector &y, Belos::ETrans) const override
      {
        copy(dynamic_cast<const Directions &>(x)[0], x_);
        of_(y_, x_);
        copy(y_, dynamic_cast<Directions &>(y)[0]);
      }

    private:
      const BlockOperator    &of_;
      mutable la::BlockVector x_, y_;
    };

    using Vectors = Belos::MultiVecTraits<double, MultiVector>;
    using Problem = Belos::LinearProblem<double, MultiVector, Belos::Operator<double>>;
    using Gmres   = Belos::BlockFGmresIter<double, MultiVector, Belos::Operator<double>>;
    using Basis   = Belos::ICGSOrthoManager<double, MultiVector, Belos::Operator<double>>;
    using Norm    = Belos::StatusTestGenResNorm<double, MultiVector, Belos::Operator<double>>;
    using Limit   = Belos::StatusTestMaxIters<double, MultiVector, Belos::Operator<double>>;
    using Either  = Belos::StatusTestCombo<double, MultiVector, Belos::Operator<double>>;

    using Teuchos::rcp;

    double norm_of(const MultiVector &x)
    {
      std::vector<double> norm(1);
      x.MvNorm(norm, Belos::TwoNorm);
      return norm[0];
    }

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

    std::vector<int> first_numbers(const int n)
    {
      std::vector<int> numbers(n);
      std::iota(numbers.begin(), numbers.end(), 0);
      return numbers;
    }

    /// y = R^(-1) y, or R^(-T) y
    void solve_triangle(const Dense &R, const Teuchos::ETransp transposition, Dense &y)
    {
      Teuchos::BLAS<int, double>().TRSM(Teuchos::LEFT_SIDE,
                                        Teuchos::UPPER_TRI,
                                        transposition,
                                        Teuchos::NON_UNIT_DIAG,
                                        y.numRows(),
                                        1,
                                        1.,
                                        R.values(),
                                        R.stride(),
                                        y.values(),
                                        y.stride());
    }

  } // namespace

  struct KrylovSpace::Basis
  {
    Teuchos::RCP<const MultiVector> Z, W;
    Dense                           R; ///< W R^(-1) is orthonormal

    /// r -= W y;  returns y.
    Dense remove_from(MultiVector &r) const
    {
      Dense y(R.numRows(), 1);
      r.MvTransMv(1., *W, y);
      solve_triangle(R, Teuchos::TRANS, y);
      solve_triangle(R, Teuchos::NO_TRANS, y);
      r.MvTimesMatAddMv(-1., *W, y, 1.);
      return y;
    }
  };

  KrylovSpace::KrylovSpace(const unsigned int room) : room_(room) {}
  KrylovSpace::KrylovSpace(KrylovSpace &&) noexcept = default;
  KrylovSpace::~KrylovSpace()                       = default;

  bool KrylovSpace::empty() const
  {
    return bases_.empty();
  }

  bool KrylovSpace::is_full() const
  {
    return bases_.size() >= room_;
  }

  void KrylovSpace::add(Basis basis)
  {
    bases_.push_back(std::move(basis));
  }

  void KrylovSpace::reduce(la::BlockVector &x, la::BlockVector &r) const
  {
    if (empty())
      return;
    Directions solution(x), residual(r);
    for (const Basis &basis : bases_)
      solution.MvTimesMatAddMv(1., *basis.Z, basis.remove_from(residual), 1.);
    copy(solution[0], x);
    copy(residual[0], r);
  }

  namespace
  {
    /// The matrix of a solve, less what a space has of its images. Of a direction z the space's bases have the parts c_b,
    /// so that  z - sum_b Z_b c_b  has the image that is left.
    class Deflated : public Belos::Operator<double>
    {
    public:
      /// @param space  null: none
      Deflated(const BlockOperator &M, const la::BlockVector &like, const KrylovSpace *space)
          : M_(M, like), space_(space)
      {
      }

      /// For products with zero, as for the residual of a solve that starts there.
      bool at_zero = false;

      /// Remembers directions from now on, one after the other.
      /// @param images  gets what is left of theirs; may be null
      void remember(const std::shared_ptr<Directions> &images, const int room)
      {
        images_ = images;
        parts_.clear();
        if (space_)
          for (const KrylovSpace::Basis &basis : space_->bases())
            parts_.emplace_back(basis.R.numRows(), room);
        n_    = 0;
        room_ = room;
      }
      void forget() { room_ = 0; }

      void Apply(const MultiVector &x, MultiVector &y, const Belos::ETrans transposition) const override
      {
        if (at_zero)
        {
          y.MvInit(0.);
          return;
        }
        M_.Apply(x, y, transposition);
        const bool remembers = n_ < room_;
        for (std::size_t b = 0; space_ && b < space_->bases().size(); ++b)
        {
          const Dense part = space_->bases()[b].remove_from(y);
          if (remembers)
            std::copy(part.values(), part.values() + part.numRows(), parts_[b][n_]);
        }
        if (remembers && images_)
          images_->SetBlock(y, {n_});
        n_ += remembers;
      }

      /// x += (Z - sum_b Z_b C_b) y  of the first n remembered directions.
      void add(const MultiVector &Z, const int n, const Dense &y, MultiVector &x) const
      {
        x.MvTimesMatAddMv(1., Z, y, 1.);
        for (std::size_t b = 0; b < parts_.size(); ++b)
        {
          const Dense C(Teuchos::View, parts_[b], parts_[b].numRows(), n);
          Dense       taken(C.numRows(), y.numCols());
          taken.multiply(Teuchos::NO_TRANS, Teuchos::NO_TRANS, -1., C, y, 0.);
          x.MvTimesMatAddMv(1., *space_->bases()[b].Z, taken, 1.);
        }
      }

    private:
      AppliedOperator             M_;
      const KrylovSpace          *space_;
      std::shared_ptr<Directions> images_;
      mutable std::vector<Dense>  parts_; ///< a column for each direction
      mutable int                 n_    = 0;
      int                         room_ = 0;
    };

    /// Adds to x the combination of directions with the least residual, which it returns; x is unchanged where that is
    /// not a number.
    double add_directions(const Belos::GmresIterationState<double, MultiVector> &state,
                          const int                                              n,
                          const Deflated                                        &matrix,
                          MultiVector                                           &x)
    {
      const double residual = std::abs((*state.z)(n, 0));
      if (n == 0)
        return residual;
      Dense y(Teuchos::Copy, *state.z, n, 1);
      solve_triangle(*state.H, Teuchos::NO_TRANS, y);
      if (!std::isfinite(residual + y.normOne()))
        return std::numeric_limits<double>::quiet_NaN();
      matrix.add(*Vectors::CloneView(*state.Z, first_numbers(n)), n, y, x);
      return residual;
    }

    /// What a solve has found, for others.
    KrylovSpace::Basis basis_of(const Belos::GmresIterationState<double, MultiVector> &state,
                                const int                                              n,
                                const Deflated                                        &matrix,
                                const MultiVector                                     &images)
    {
      Dense identity(n, n);
      for (int j = 0; j < n; ++j)
        identity(j, j) = 1.;
      const auto Z = Teuchos::rcp(images.Clone(n));
      Z->MvInit(0.);
      matrix.add(*Vectors::CloneView(*state.Z, first_numbers(n)), n, identity, *Z);
      return {Z, Vectors::CloneView(images, first_numbers(n)), Dense(Teuchos::Copy, *state.H, n, n)};
    }
  } // namespace

  KrylovResult solve_by_flexible_gmres(const BlockOperator   &M,
                                       const BlockOperator   &P,
                                       const la::BlockVector &b,
                                       la::BlockVector       &x,
                                       const double           tolerance,
                                       const unsigned int     limit,
                                       const unsigned int     restart,
                                       KrylovSpace           *space)
  {
    const auto X = rcp(new Directions(x)), B = rcp(new Directions(b));
    const bool deflates = space && !space->empty(), keeps = space && !space->is_full();
    Assert(!deflates || x.l2_norm() == 0., dealii::ExcMessage("a solve beside a space starts at zero"));
    const auto matrix  = rcp(new Deflated(M, b, deflates ? space : nullptr));
    const auto problem = rcp(new Problem(matrix, X, B));
    problem->setRightPrec(rcp(new AppliedOperator(P, b)));
    matrix->at_zero = deflates;
    problem->setProblem();
    matrix->at_zero = false;
    problem->setLSIndex({0});

    const auto norm = rcp(new Norm(tolerance));
    norm->defineResForm(Norm::Implicit, Belos::TwoNorm);
    norm->defineScaleForm(Belos::None, Belos::TwoNorm);
    Teuchos::ParameterList list;
    const int              room = std::min<int>(std::min(restart, limit), X->GetGlobalLength());
    list.set("Num Blocks", room);
    Gmres gmres(problem,
                rcp(new Belos::OutputManager<double>(Belos::Errors)),
                rcp(new Either(Either::OR, rcp(new Limit(limit)), norm)),
                rcp(new Basis("Belos", Teuchos::null, passes)),
                list);

    KrylovResult                                    result;
    Belos::GmresIterationState<double, MultiVector> first;
    const auto                                      r = Vectors::CloneCopy(*problem->getInitResVec());
    const auto                                      z = rcp(new Dense(1, 1));
    first.V                                           = r;
    first.z                                           = z;
    double                            residual        = norm_of(*r);
    std::optional<KrylovSpace::Basis> found;
    while (residual > tolerance && result.iterations < limit)
    {
      r->MvScale(1. / residual);
      (*z)(0, 0) = residual;
      gmres.initializeGmres(first);
      found.reset(); // directions before take the same room
      const auto images =
        std::shared_ptr<Directions>(keeps ? dynamic_cast<Directions *>(X->Clone(room)) : nullptr);
      matrix->remember(images, room);
      const int  n     = iterate(gmres);
      const auto state = gmres.getState();
      matrix->forget();
      residual          = add_directions(state, n, *matrix, *X);
      result.iterations = gmres.getNumIters();
      if (keeps && n > 0 && std::isfinite(residual))
        found = basis_of(state, n, *matrix, *images);
      if (residual > tolerance)
      {
        problem->computeCurrResVec(r.get());
        residual = norm_of(*r);
      }
    }
    if (found)
      space->add(std::move(*found));
    copy((*X)[0], x);
    result.converged = residual <= tolerance;
    return result;
  }
} // namespace retroforge
