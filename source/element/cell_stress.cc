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
    SymmetricTensor s{};
    for (const auto &eps : SubStrainRates<double>(geometry, w.V, w.beta).eps)
    {
      const double eps2 = double_contraction(eps, eps);
      if (eps2 == 0.) // the factor of a law without e0 is infinite there
        continue;
      const double factor = 0.25 * law(eps2);
      for (unsigned int k = 0; k < 6; ++k)
        s[k] += factor * eps[k];
    }
    const double mean = (s[0] + s[1] + s[2]) / 3.;
    for (unsigned int k = 0; k < 3; ++k)
      s[k] -= mean;
    return s;
  }

  double von_mises(const SymmetricTensor &s)
  {
    return std::sqrt(1.5 * double_contraction(s, s));
  }
} // namespace retroforge
