// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/linear_algebra/chebyshev_smoother.h>

#include <deal.II/base/mpi.h>

#include <Epetra_CrsMatrix.h>
#include <Epetra_Import.h>
#include <Epetra_Vector.h>

#include <cstring>

namespace retroforge
{
  namespace
  {
    constexpr unsigned int steps = 3;

    /// Largest over smallest eigenvalue of the spectrum that is damped.
    constexpr float largest_over_smallest = 10.;

    /// The power method comes from below, and beyond the spectrum the iteration would diverge.
    constexpr unsigned int power_steps    = 10;
    constexpr float        above_estimate = 1.1;

    /// Three numbers and one that does not count: arrays of threes end with a spare one.
    typedef float FloatLanes __attribute__((vector_size(16)));

    FloatLanes load(const float *x)
    {
      FloatLanes lanes;
      std::memcpy(&lanes, x, sizeof lanes);
      return lanes;
    }
  } // namespace

  ChebyshevSmoother::ChebyshevSmoother(const la::SparseMatrix &A)
      : A_(A), n_rows_(A.trilinos_matrix().NumMyRows()), blocks_(A)
  {
    take_diagonal();
    z_.assign(A.trilinos_matrix().NumMyCols(), 0.);
    r_.assign(n_rows_ + 1, 0.);
    defect_ = change_ = r_;
    largest_          = above_estimate * largest_eigenvalue();
  }

  void ChebyshevSmoother::take_diagonal()
  {
    Epetra_Vector diagonal(A_.trilinos_matrix().RowMap(), false);
    A_.trilinos_matrix().ExtractDiagonalCopy(diagonal);
    for (unsigned int i = 0; i < n_rows_; ++i)
      inverse_diagonal_.push_back(1. / diagonal[i]);
  }

  float ChebyshevSmoother::largest_eigenvalue() const
  {
    // From a vector that is rough and the same on any number of ranks.
    const int first = A_.trilinos_matrix().RowMap().GID(0);
    for (unsigned int i = 0; i < n_rows_; ++i)
      defect_[i] = std::cos(static_cast<double>(first + i) * (first + i));
    float norm = 0.;
    for (unsigned int step = 0; step <= power_steps; ++step)
    {
      double norm2 = 0.;
      for (unsigned int i = 0; i < n_rows_; ++i)
        norm2 += static_cast<double>(defect_[i]) * defect_[i];
      norm = std::sqrt(dealii::Utilities::MPI::sum(norm2, A_.get_mpi_communicator()));
      for (unsigned int i = 0; i < n_rows_; ++i)
        z_[i] = defect_[i] / norm;
      compute_defect();
    }
    return norm;
  }

  void ChebyshevSmoother::fetch_columns() const
  {
    const Epetra_CrsMatrix &A = A_.trilinos_matrix();
    if (A.Importer() == nullptr)
      return;
    Epetra_Vector own(A.DomainMap()), all(A.ColMap());
    for (unsigned int i = 0; i < n_rows_; ++i)
      own[i] = z_[i];
    all.Import(own, *A.Importer(), Insert);
    for (unsigned int i = n_rows_; i < z_.size(); ++i)
      z_[i] = all[i];
  }

  void ChebyshevSmoother::compute_defect() const
  {
    fetch_columns();
    for (unsigned int row = 0; row < n_rows_; row += 3)
    {
      FloatLanes first = load(&r_[row]), second = {}, third = {};
      for (unsigned int e = blocks_.begin[row / 3]; e < blocks_.begin[row / 3 + 1]; ++e)
      {
        const float *block = &blocks_.values[9 * e], *z = &z_[blocks_.columns[e]];
        first -= load(block) * z[0];
        second -= load(block + 3) * z[1];
        third -= load(block + 6) * z[2];
      }
      const FloatLanes sum = first + second + third;
      for (unsigned int i = 0; i < 3; ++i)
        defect_[row + i] = inverse_diagonal_[row + i] * sum[i];
    }
  }

  void ChebyshevSmoother::smooth(la::Vector &z, const la::Vector &r) const
  {
    AssertDimension(z.locally_owned_size(), n_rows_);
    AssertDimension(r.locally_owned_size(), n_rows_);
    std::copy(z.begin(), z.end(), z_.begin());
    std::copy(r.begin(), r.end(), r_.begin());
    const float smallest = largest_ / largest_over_smallest;
    const float centre = 0.5f * (largest_ + smallest), radius = 0.5f * (largest_ - smallest);
    float       rho = 0.;
    for (unsigned int step = 0; step < steps; ++step)
    {
      compute_defect();
      const float of_defect = step == 0 ? 1.f : 2.f;
      const float next      = 1.f / (of_defect * centre / radius - rho);
      for (unsigned int i = 0; i < n_rows_; ++i)
      {
        change_[i] = next * (rho * change_[i] + of_defect / radius * defect_[i]);
        z_[i] += change_[i];
      }
      rho = next;
    }
    std::copy(z_.begin(), z_.begin() + n_rows_, z.begin());
  }
} // namespace retroforge
