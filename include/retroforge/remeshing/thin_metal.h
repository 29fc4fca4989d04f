// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/remeshing/peeled_mesh.h>

namespace retroforge
{
  /// How far from a sliver or a crossing thin metal may go for it, over the wanted length.
  constexpr double reach_of_thin = 2.;

  /// Returns the cells whose nodes are all on the surface: metal one element thick. Nodes on a plane of
  /// symmetry alone do not count.
  std::vector<CellIndex> thin_cells(const TetMesh &mesh);

  /// Returns thin metal around a point, with the centres of its cells nearer than a distance [mm], the smallest cells
  /// first.
  std::vector<CellIndex> thin_cells_near(const PeeledMesh &peeled, const Vec3 &x, double near);

  /// Returns the mean of a cell's corners.
  Vec3 centre_of(const TetMesh &mesh, CellIndex cell);
} // namespace retroforge
