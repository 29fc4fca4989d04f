// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/element/cell_stress.h>
#include <retroforge/element/mini_element.templates.h>

namespace retroforge
{
  SymmetricTensor cell_deviatoric_stress(const CellGeometry<double> &geometry,
                                         const CellValues<double>   &w,
                                         const MaterialLaw<double>  &law)
  {
    return mean_deviatoric_stress(SubStrainRates<double>(geometry, w.V, w.beta).eps, law);
  }

  double von_mises(const SymmetricTensor &s)
  {
    return std::sqrt(1.5 * double_contraction(s, s));
  }
} // namespace retroforge
