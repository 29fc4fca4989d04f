// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/element/cell_geometry.templates.h>

namespace retroforge
{
  template CellGeometry<double> cell_geometry(const Four<Vector3<double>> &);
  template CellGeometry<Dual>   cell_geometry(const Four<Vector3<Dual>> &);

  void reverse_cell_geometry(const CellGeometry<double> &geometry,
                             const double                volume_bar,
                             const Four<Vec3>           &g_bar,
                             Four<Vec3>                 &X_bar)
  {
    const auto &g = geometry.g;
    for (unsigned int c = 0; c < 4; ++c)
    {
      X_bar[c] += geometry.volume * volume_bar * g[c];
      for (unsigned int a = 0; a < 4; ++a)
        X_bar[c] -= (g[c] * g_bar[a]) * g[a];
    }
  }
} // namespace retroforge
