// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/element/corner_rates.h>

namespace retroforge
{
  PointRates<double> corner_strain_rates(const CellGeometry<double> &geometry, const CellValues<double> &w)
  {
    Symmetric<double> eps = {};
    for (unsigned int c = 0; c < 4; ++c)
      add_dyad(w.V[c], geometry.g[c], eps);
    return {{eps, eps, eps, eps}};
  }

  // At corner k the fields U_c of taylor_hood.h are 4 W_ck - V_c.
  PointRates<double> corner_strain_rates(const CellGeometry<double>     &geometry,
                                         const TaylorHoodValues<double> &w)
  {
    PointRates<double> eps = {};
    for (unsigned int k = 0; k < 4; ++k)
      add_dyad(3. * w.V[k], geometry.g[k], eps[k]);
    for (unsigned int e = 0; e < 6; ++e)
    {
      const auto [c, k] = tet_edge_corners[e];
      add_dyad(4. * w.V[4 + e] - w.V[c], geometry.g[c], eps[k]);
      add_dyad(4. * w.V[4 + e] - w.V[k], geometry.g[k], eps[c]);
    }
    return eps;
  }
} // namespace retroforge
