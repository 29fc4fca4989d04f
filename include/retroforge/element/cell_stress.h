// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/element/mini_element.h>
#include <retroforge/element/point_rates.h>

namespace retroforge
{
  using SymmetricTensor = Symmetric<double>;

  /// Deviatoric stress of a cell [MPa]: the mean over the four sub-tetrahedra, of equal volume, of the law's
  /// s_a = 2 K chi_a^((m-1)/2) eps_a, without the trace that is left where the discrete flow is not quite
  /// incompressible.
  SymmetricTensor cell_deviatoric_stress(const CellGeometry<double> &geometry,
                                         const CellValues<double>   &w,
                                         const MaterialLaw<double>  &law);

  /// Equivalent stress sqrt(3/2 s:s) of a deviator s [MPa].
  double von_mises(const SymmetricTensor &s);
} // namespace retroforge
