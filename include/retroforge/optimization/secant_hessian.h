// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/lac/full_matrix.h>

#include <vector>

namespace retroforge
{
  /// A Hessian that is learned from changes of the gradient: after each step the symmetric matrix of rank one
  /// is added that explains the last one; or, where that would be large, as what is missing is nearly across
  /// the step, the least matrix by Frobenius' norm (Powell's symmetric Broyden update). It may bend downwards,
  /// and an error of a gradient changes it by no more than five times the error over the step; BFGS, which must
  /// bend upwards, takes both for walls. With many variables, of which a search sees few directions, it is BFGS
  /// none the less where both the step and what was known bend upwards: it finds the stiffest ones sooner.
  /// @cite Nocedal and Wright 2006, section 6.2; Dennis and Schnabel 1983, section 9.1
  class SecantHessian
  {
  public:
    /// Before anything is learned it is one; the first step scales it, where it bends upwards.
    std::vector<double> times(const std::vector<double> &v) const;

    /// @param change  of the gradient over the step
    /// @param noise   of the function: steps over which it bends by less teach nothing
    void learn(const std::vector<double> &step, const std::vector<double> &change, double noise);

  private:
    static constexpr unsigned int most_of_rank_1 = 10; ///< variables: about as many as a search has steps

    dealii::FullMatrix<double> matrix_; ///< empty: one
  };
} // namespace retroforge
