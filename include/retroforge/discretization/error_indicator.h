// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/discretization/element_pairs.h>
#include <retroforge/material/material.h>

namespace retroforge
{
  /// Degree p of the velocities without bubbles: a cell's indicated error falls as its size to the power 2 p.
  inline unsigned int velocity_degree(const Discretization<3> &discretization)
  {
    return discretization.pair() == ElementPair::mini ? 1 : 2;
  }

  /// Returns the contribution of each cell to the error of the power, as indicated by jumps of the strain
  /// rate [mJ/s]:
  ///
  ///   eta_T = int_T (s(eps*) - s(eps)) : (eps* - eps) >= 0,
  ///
  /// eps the deviatoric strain rate of the cell, eps* the recovered one: at each node the mean of the cells
  /// around it, by their volumes, and linear between. The power functional is convex with the stress s as its
  /// gradient, so that this is twice its error to second order if eps* were exact.
  /// @param X, W    positions [mm] and velocities [mm/s]
  /// @param points  state of the metal in each cell
  /// @return of all cells, on every rank. Collective.
  /// Cells that are inverted count as flat: nothing. @cite Zienkiewicz1987
  std::vector<double> indicated_errors(const Discretization<3>               &discretization,
                                       const NodalVectors<double>            &X,
                                       const Field<double>                   &W,
                                       const Material<double>                &material,
                                       const std::vector<PointState<double>> &points);
} // namespace retroforge
