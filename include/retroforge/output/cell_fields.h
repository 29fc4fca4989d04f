// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/discretization/element_pairs.h>

#include <functional>

namespace retroforge
{
  /// What pictures show of the metal in each cell: means over its volume.
  struct CellFields
  {
    std::vector<double>            strain_rate; ///< e = sqrt(2/3 eps:eps) [1/s]
    std::vector<double>            von_mises;   ///< sqrt(3/2 s:s) of the mean s [MPa]
    std::vector<Symmetric<double>> stress;      ///< s, the deviator [MPa]
    std::vector<double>            flow_stress; ///< of the law at this strain rate [MPa]
  };

  /// Evaluates a flow cell by cell with the kernels that the discretisation assembles, so that a pair of
  /// elements that is assembled has pictures.
  /// @param X    positions [mm]
  /// @param W    [mm/s, MPa], bubbles among it
  /// @param law  of the metal in a cell
  /// @return of all cells, on every rank. Collective.
  template <int dim>
  CellFields cell_fields(const Discretization<dim>                             &discretization,
                         const CellVectors<dim, double>                        &X,
                         const FlowField<dim, double>                          &W,
                         const std::function<MaterialLaw<double>(CellIndex c)> &law);
} // namespace retroforge
