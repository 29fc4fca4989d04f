// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/linear_algebra/p_multigrid.h>

#include <Epetra_CrsMatrix.h>
#include <ml_epetra_utils.h>
#include <ml_utils.h>

namespace retroforge
{
  namespace
  {
    /// P^T A P
    void multiply(const la::SparseMatrix &A, const la::SparseMatrix &P, la::SparseMatrix &product)
    {
      Epetra_CrsMatrix *made = nullptr;
      ML_Epetra::ML_Epetra_PtAP(A.trilinos_matrix(), P.trilinos_matrix(), made);
      const std::unique_ptr<Epetra_CrsMatrix> owner(made);
      product.reinit(*made);
    }

    /// The first n_first entries of each of three vectors.
    std::vector<double> first_rows(const std::vector<double> &vectors, const unsigned int n_first)
    {
      std::vector<double> first;
      for (unsigned int mode = 0; mode < 3; ++mode)
      {
        const auto begin = vectors.begin() + mode * (vectors.size() / 3);
        first.insert(first.end(), begin, begin + n_first);
      }
      return first;
    }
  } // namespace

  PMultigrid::PMultigrid(const la::SparseMatrix    &A,
                         const la::SparseMatrix    &P,
                         const std::vector<double> &near_kernel)
      : P_(P)
      , smoother_(A)
      , linear_r_(P.locally_owned_domain_indices(), A.get_mpi_communicator())
      , linear_z_(linear_r_)
  {
    AssertDimension(near_kernel.size(), 3 * static_cast<std::size_t>(A.trilinos_matrix().NumMyRows()));
    multiply(A, P, linear_);
    // ML guesses eigenvalues from random vectors: always the same ones.
    ML_set_random_seed(1);
    of_linear_ = make_algebraic_multigrid(linear_.trilinos_matrix(),
                                          first_rows(near_kernel, linear_r_.locally_owned_size()));
  }

  void PMultigrid::vmult(la::Vector &z, const la::Vector &r) const
  {
    P_.Tvmult(linear_r_, r);
    of_linear_->vmult(linear_z_, linear_r_);
    P_.vmult(z, linear_z_);
    smoother_.smooth(z, r);
  }
} // namespace retroforge
