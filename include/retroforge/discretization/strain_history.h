// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/discretization/element_pairs.h>

#include <vector>

/// @file
/// The accumulated equivalent strain  q(t) = int_0^t e dt,  e = sqrt(2/3 eps:eps),  of each piece of
/// material.
///
/// It is kept per cell,  q_T += dt ebar_T,  ebar_T = 1/4 sum_a e_a  the mean of the strain rates at the four
/// points that stand for a quarter of its volume each. Strain rates live in cells: kept at nodes, every
/// increment would average them over the neighbours and then again, and the history would diffuse with time
/// even without remeshing. Cells move with the material, so between remeshings the update needs no other cell
/// and no mass matrix. When the mesh changes: transfer_cells(). The strain rate is not regularised (no e0):
/// material at rest accumulates nothing.
namespace retroforge
{
  /// q_np1 = q_n + dt ebar(X, W)  of the cells this rank owns, one value per cell, dimensionless; the others'
  /// stays.
  /// @param X, W   positions [mm] and velocities [mm/s] of the increment's last stage
  template <typename Number, int dim>
  std::vector<Number> accumulate_strain(const Discretization<dim>      &discretization,
                                        const CellVectors<dim, Number> &X,
                                        const FlowField<dim, Number>   &W,
                                        const Number                   &dt,
                                        const std::vector<Number>      &q_n);

  /// Pull-back of accumulate_strain: adds dt q_bar_T debar_T of the cells this rank owns to W_bar (V) and
  /// X_bar.
  /// @param q_bar  adjoint of q_np1, and as it is that of q_n
  /// @return derivative in dt,  sum_T q_bar_T ebar_T
  template <int dim>
  double reverse_accumulate_strain(const Discretization<dim>      &discretization,
                                   const CellVectors<dim, double> &X,
                                   const FlowField<dim, double>   &W,
                                   double                          dt,
                                   const std::vector<double>      &q_bar,
                                   FlowField<dim, double>         &W_bar,
                                   CellVectors<dim, double>       &X_bar);
} // namespace retroforge
