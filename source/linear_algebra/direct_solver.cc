// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/linear_algebra/direct_solver.h>

#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <Amesos_Mumps.h>
#include <Epetra_LinearProblem.h>

#include <cmath>
#include <iostream>
#include <memory>

namespace retroforge
{
  namespace
  {
    /// Status of MUMPS: INFOG(1), which is negative where it failed, and INFOG(2).  See its manual.
    struct MumpsStatus
    {
      int code, detail;

      bool lacks_workspace() const { return code == -8 || code == -9; }
      bool lacks_memory() const { return code == -13 || code == -7 || code == -5; }
    };

    /// Amesos prints the failures of MUMPS, which are ours to tell.
    class SilentErrors
    {
    public:
      SilentErrors() : buffer_(std::cerr.rdbuf(nullptr)) {}
      ~SilentErrors()
      {
        std::cerr.rdbuf(buffer_);
        std::cerr.clear();
      }
      SilentErrors(const SilentErrors &)            = delete;
      SilentErrors &operator=(const SilentErrors &) = delete;

    private:
      std::streambuf *buffer_;
    };

    MumpsStatus solve_once(const Epetra_LinearProblem &problem,
                           const Transposition         transposition,
                           const int                   spare,
                           MPI_Comm                    comm)
    {
      const SilentErrors silent;
      Amesos_Mumps       mumps(problem);
      mumps.SetUseTranspose(transposition == Transposition::transposed);
      mumps.SetICNTL(14, spare);
      if (mumps.SymbolicFactorization() == 0 && mumps.NumericFactorization() == 0)
        mumps.Solve();
      MumpsStatus status{mumps.GetINFOG()[0], mumps.GetINFOG()[1]};
      MPI_Bcast(&status, 2, MPI_INT, 0, comm);
      return status;
    }

    [[noreturn]] void throw_failure(const MumpsStatus &status)
    {
      if (status.lacks_workspace() || status.lacks_memory())
        throw Error("Linear solver",
                    "MUMPS has not enough memory (INFOG(1) = " + std::to_string(status.code) + ")",
                    "the factors of a direct solve must fit into memory",
                    "use a coarser mesh or more ranks on more machines, or Linear solver/method = ilu");
      throw NoLinearSolution("Linear solver",
                             "finds no solution (MUMPS: INFOG(1) = " + std::to_string(status.code) +
                               ", INFOG(2) = " + std::to_string(status.detail) + ")",
                             "a linear system must be regular, its numbers within the range of doubles",
                             "use values of the usual size: penalties and friction above all");
    }

    bool is_finite(const la::Vector &x)
    {
      return std::isfinite(x.l2_norm());
    }
  } // namespace

  unsigned int solve_by_mumps(const la::SparseMatrix &A,
                              const la::Vector       &b,
                              la::Vector             &x,
                              const Transposition     transposition,
                              int                     spare)
  {
    const Epetra_LinearProblem problem(const_cast<Epetra_CrsMatrix *>(&A.trilinos_matrix()),
                                       &x.trilinos_vector(),
                                       const_cast<Epetra_MultiVector *>(&b.trilinos_vector()));
    constexpr int              most = 2000;
    for (unsigned int calls = 1;; ++calls, spare = std::max(100, 3 * spare))
    {
      const MumpsStatus status = solve_once(problem, transposition, spare, A.get_mpi_communicator());
      if (status.code >= 0 && is_finite(x))
        return calls;
      if (!status.lacks_workspace() || spare > most)
        throw_failure(status);
    }
  }

  namespace
  {
    /// Numbers of the rows of blocks in one matrix, where each rank has its rows of the first block, then
    /// those of the next.
    class MergedNumbers
    {
    public:
      /// @param n_more  rows after all others, which the last rank has
      MergedNumbers(const la::BlockSparseMatrix &A, const unsigned int n_more)
          : first_(A.n_block_rows()), shift_(A.n_block_rows())
      {
        using namespace dealii::Utilities::MPI;
        const MPI_Comm                comm = A.get_mpi_communicator();
        std::vector<std::vector<int>> sizes;
        for (unsigned int block = 0; block < first_.size(); ++block)
          sizes.push_back(all_gather(
            comm, static_cast<int>(A.block(block, block).locally_owned_range_indices().n_elements())));
        int              n = 0;
        std::vector<int> begin(first_.size(), 0);
        for (unsigned int rank = 0; rank < n_mpi_processes(comm); ++rank)
        {
          if (rank == this_mpi_process(comm))
            n_before = n;
          for (unsigned int block = 0; block < first_.size(); ++block)
          {
            first_[block].push_back(begin[block]);
            shift_[block].push_back(n - begin[block]);
            begin[block] += sizes[block][rank];
            n += sizes[block][rank];
          }
          if (rank == this_mpi_process(comm))
            n_owned = n - n_before;
        }
        n_of_blocks = n;
        n_all       = n + n_more;
        if (this_mpi_process(comm) + 1 == n_mpi_processes(comm))
          n_owned += n_more;
      }

      unsigned int operator()(const unsigned int block, const int row) const
      {
        const auto owner = std::upper_bound(first_[block].begin(), first_[block].end(), row) - 1;
        return row + shift_[block][owner - first_[block].begin()];
      }

      int n_before = 0, n_owned = 0, n_of_blocks = 0, n_all = 0;

    private:
      std::vector<std::vector<int>> first_, shift_; ///< of each block and rank
    };

    using Products = std::vector<std::pair<la::Vector, la::Vector>>;

    /// Calls f(row, column, value) for the entries of the rows and columns that products add. Collective.
    template <typename F>
    void for_each_entry(const Products &products, const MergedNumbers &number, const F &f)
    {
      for (unsigned int j = 0; j < products.size(); ++j)
      {
        const auto &[row, column]  = products[j];
        const unsigned int more    = number.n_of_blocks + j;
        const bool         is_mine = static_cast<int>(more) >= number.n_before &&
                             static_cast<int>(more) < number.n_before + number.n_owned;
        std::vector<std::pair<unsigned int, double>> of_column;
        for (const auto i : row.locally_owned_elements())
        {
          f(number(0, i), more, row(i));
          of_column.emplace_back(number(0, i), column(i));
        }
        for (const auto &part : dealii::Utilities::MPI::all_gather(row.get_mpi_communicator(), of_column))
          for (const auto &[i, value] : part)
            if (is_mine)
              f(more, i, value);
        if (is_mine)
          f(more, more, -1.);
      }
    }

    /// Calls f(row, column, value) for the entries that this rank has, in merged numbers.
    template <typename F>
    void for_each_entry(const la::BlockSparseMatrix &A, const MergedNumbers &number, const F &f)
    {
      for (unsigned int r = 0; r < A.n_block_rows(); ++r)
        for (unsigned int c = 0; c < A.n_block_cols(); ++c)
        {
          const Epetra_CrsMatrix &block = A.block(r, c).trilinos_matrix();
          for (int local = 0; local < block.NumMyRows(); ++local)
          {
            int     n;
            int    *columns;
            double *values;
            block.ExtractMyRowView(local, n, values, columns);
            const unsigned int row = number(r, block.GRID(local));
            for (int e = 0; e < n; ++e)
              f(row, number(c, block.GCID(columns[e])), values[e]);
          }
        }
    }
  } // namespace

  unsigned int solve_by_mumps(const la::BlockSparseMatrix &A,
                              const la::BlockVector       &b,
                              la::BlockVector             &x,
                              const Transposition          transposition,
                              const Products              &products)
  {
    const MergedNumbers number(A, products.size());
    const MPI_Comm      comm = A.get_mpi_communicator();
    dealii::IndexSet    rows(number.n_all);
    rows.add_range(number.n_before, number.n_before + number.n_owned);
    dealii::DynamicSparsityPattern pattern(number.n_all, number.n_all, rows);
    const auto                     meet = [&](const unsigned int row, const unsigned int column, double) {
      pattern.add(row, column);
    };
    for_each_entry(A, number, meet);
    for_each_entry(products, number, meet);
    la::SparseMatrix merged;
    merged.reinit(rows, rows, pattern, comm);
    const auto set = [&](const unsigned int row, const unsigned int column, const double value) {
      merged.set(row, column, value);
    };
    for_each_entry(A, number, set);
    for_each_entry(products, number, set);
    merged.compress(dealii::VectorOperation::insert);
    la::Vector b_merged(rows, comm), x_merged(rows, comm);
    double    *to = b_merged.begin();
    for (unsigned int block = 0; block < b.n_blocks(); ++block)
      to = std::copy(b.block(block).begin(), b.block(block).end(), to);
    const unsigned int calls = solve_by_mumps(merged, b_merged, x_merged, transposition);
    const double      *from  = x_merged.begin();
    for (unsigned int block = 0; block < x.n_blocks(); ++block)
    {
      std::copy(from, from + x.block(block).locally_owned_size(), x.block(block).begin());
      from += x.block(block).locally_owned_size();
    }
    return calls;
  }
} // namespace retroforge
