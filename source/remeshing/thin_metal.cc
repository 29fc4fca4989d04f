// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/remeshing/thin_metal.h>

#include <algorithm>

namespace retroforge
{
  std::vector<CellIndex> thin_cells(const TetMesh &mesh)
  {
    std::vector<bool> on_surface(mesh.n_nodes(), false);
    for (const BoundaryFace &face : mesh.faces)
      if (mesh.is_surface(face))
        for (const NodeIndex k : face.nodes)
          on_surface[k] = true;
    std::vector<CellIndex> cells;
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    {
      const auto &cell = mesh.cells[c];
      if (std::all_of(cell.begin(), cell.end(), [&](const NodeIndex k) { return on_surface[k]; }))
        cells.push_back(c);
    }
    return cells;
  }

  std::vector<CellIndex> thin_cells_near(const PeeledMesh &peeled, const Vec3 &x, const double near)
  {
    std::set<std::pair<double, CellIndex>> found;
    for (const CellIndex c : thin_cells(peeled.mesh()))
      if ((centre_of(peeled.mesh(), c) - x).norm() < near)
        found.insert({peeled.volume(c), c});
    std::vector<CellIndex> cells;
    for (const auto &[volume, c] : found)
      cells.push_back(c);
    return cells;
  }

  Vec3 centre_of(const TetMesh &mesh, const CellIndex cell)
  {
    Vec3 sum;
    for (const NodeIndex k : mesh.cells[cell])
      sum += 0.25 * mesh.X[k];
    return sum;
  }
} // namespace retroforge
