// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/cell_faces.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/mesh/recovered_gradient.h>

namespace retroforge
{
  RecoveredGradient::RecoveredGradient(const TetMesh &mesh, const NodalVectors<double> &X)
      : mesh_(mesh), X_(X), topology_(mesh)
  {
  }

  bool RecoveredGradient::exists(const NodeIndex a) const
  {
    for (const CellIndex c : topology_.cells[a])
      if (!(tet_volume(corners(mesh_.cells[c], X_)) > 0))
        return false;
    return true;
  }

  void RecoveredGradient::add_directional(const NodeIndex                            a,
                                          const Vec3                                &direction,
                                          std::vector<std::pair<NodeIndex, double>> &coefficients) const
  {
    double sum = 0;
    for (const CellIndex c : topology_.cells[a])
      sum += tet_volume(corners(mesh_.cells[c], X_));
    for (const CellIndex c : topology_.cells[a])
    {
      const TetCorners x = corners(mesh_.cells[c], X_);
      // |T| grad lambda_b = -(outward area vector of the face opposite b) / 3
      for (unsigned int b = 0; b < 4; ++b)
      {
        const auto &face       = tet_face_corners[b];
        const Vec3  twice_area = cross_product_3d(x[face[1]] - x[face[0]], x[face[2]] - x[face[0]]);
        coefficients.emplace_back(mesh_.cells[c][b], -(twice_area * direction) / (6 * sum));
      }
    }
  }
} // namespace retroforge
