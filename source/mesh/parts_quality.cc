// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/mpi.h>

#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/mesh/parts_quality.h>

#include <limits>

namespace retroforge
{
  double volume(const TetMesh &mesh, const NodalVectors<double> &X, const ReplicatedEntries &cells)
  {
    double sum = 0.;
    for (const CellIndex c : cells.owned())
      sum += tet_volume(corners(mesh.cells[c], X));
    return dealii::Utilities::MPI::sum(sum, cells.comm());
  }

  double minimum_quality(const TetMesh &mesh, const NodalVectors<double> &X, const ReplicatedEntries &cells)
  {
    double quality = std::numeric_limits<double>::max();
    for (const CellIndex c : cells.owned())
      quality = std::min(quality, tet_quality(corners(mesh.cells[c], X)));
    return dealii::Utilities::MPI::min(quality, cells.comm());
  }
} // namespace retroforge
