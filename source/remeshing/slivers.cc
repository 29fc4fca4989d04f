// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/remeshing/slivers.h>
#include <retroforge/remeshing/thin_metal.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    using Cell = std::array<NodeIndex, 4>;

    /// Cells behind the faces in planes of symmetry.
    std::set<CellIndex> cells_in_planes(const PeeledMesh &peeled)
    {
      std::set<CellIndex> cells;
      for (const BoundaryFace &face : peeled.mesh().faces)
        if (!peeled.mesh().is_surface(face))
          cells.insert(peeled.cell_behind(face.nodes));
      return cells;
    }

    /// Returns the cells that are flatter than a degree and have a face or all their nodes on the surface, the
    /// flattest first.
    std::vector<Cell> slivers(const PeeledMesh &peeled)
    {
      const double        limit = std::sin(M_PI / 180.);
      const TetMesh      &mesh  = peeled.mesh();
      const auto          thin  = thin_cells(mesh);
      std::set<CellIndex> at_surface(thin.begin(), thin.end());
      for (const BoundaryFace &face : mesh.faces)
        if (mesh.is_surface(face))
          at_surface.insert(peeled.cell_behind(face.nodes));
      std::set<std::pair<double, Cell>> found;
      for (const CellIndex c : at_surface)
        if (const double quality = tet_quality(corners(mesh.cells[c], mesh.X)); quality < limit)
          found.insert({quality, mesh.cells[c]});
      std::vector<Cell> cells;
      for (const auto &[quality, cell] : found)
        cells.push_back(cell);
      return cells;
    }

    /// The mesh without the sliver; nothing when it has to stay.
    /// @param near  of thin metal that may go for it [mm]
    std::optional<PeeledMesh>
    without(const Cell &sliver, PeeledMesh peeled, const double most, const double near)
    {
      for (;;)
      {
        const auto &cells = peeled.mesh().cells;
        const auto  found = std::find(cells.begin(), cells.end(), sliver);
        if (found == cells.end())
          return peeled;
        const CellIndex        cell = found - cells.begin();
        std::vector<CellIndex> in_turn{cell};
        for (const auto &more : {peeled.surface_cells_beside(cell),
                                 thin_cells_near(peeled, centre_of(peeled.mesh(), cell), near)})
          in_turn.insert(in_turn.end(), more.begin(), more.end());
        const auto stays = [planes = cells_in_planes(peeled)](const CellIndex c) {
          return planes.count(c) > 0;
        };
        in_turn.erase(std::remove_if(in_turn.begin(), in_turn.end(), stays), in_turn.end());
        if (!peeled.remove_first(in_turn, most))
          return {};
      }
    }
  } // namespace

  std::optional<RepairedMesh> without_slivers(const TetMesh                             &mesh,
                                              const NodalVectors<double>                &X,
                                              const std::function<double(const Vec3 &)> &size,
                                              const double                               most)
  {
    PeeledMesh peeled(mesh, X);
    // What goes with one can let another go that had to stay.
    const auto remove_one = [&]() {
      for (const Cell &sliver : slivers(peeled))
      {
        const double h = size(X[sliver[0]]);
        if (auto made =
              without(sliver, peeled, std::min(most, peeled.removed() + h * h * h), reach_of_thin * h))
        {
          peeled = std::move(*made);
          return true;
        }
      }
      return false;
    };
    while (remove_one())
      ;
    if (peeled.mesh().n_cells() == mesh.n_cells())
      return {};
    return peeled.result();
  }
} // namespace retroforge
