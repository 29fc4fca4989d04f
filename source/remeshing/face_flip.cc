// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/cell_faces.h>
#include <retroforge/remeshing/face_flip.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    // The other cell at a face; invalid_index on the boundary.
    CellIndex
    cell_across(const EditableMesh &mesh, const CellIndex cell, const std::array<NodeIndex, 3> &face)
    {
      for (const CellIndex other : mesh.cells_at(face[0]))
        if (other != cell && contains(mesh.cell(other), face[1]) && contains(mesh.cell(other), face[2]))
          return other;
      return invalid_index;
    }

    NodeIndex apex(const Cell &cell, const std::array<NodeIndex, 3> &face)
    {
      return *std::find_if(
        cell.begin(), cell.end(), [&](const NodeIndex node) { return !contains(face, node); });
    }
  } // namespace

  std::optional<CavityChange> plan_face_flip(const RemeshingContext &context,
                                             const CellIndex         cell,
                                             const unsigned int      corner,
                                             const double            least_gain)
  {
    const EditableMesh            &mesh  = context.mesh;
    const Cell                    &nodes = mesh.cell(cell);
    const auto                    &local = tet_face_corners[corner];
    const std::array<NodeIndex, 3> face  = {{nodes[local[0]], nodes[local[1]], nodes[local[2]]}};
    const CellIndex                other = cell_across(mesh, cell, face);
    if (other == invalid_index)
      return {};
    const NodeIndex below = nodes[corner], above = apex(mesh.cell(other), face);
    if (mesh.is_edge(below, above))
      return {};
    CavityChange change;
    change.removed_cells = {cell, other};
    // The face turns counter-clockwise seen from above.
    for (unsigned int i = 0; i < 3; ++i)
      change.added_cells.push_back({{below, above, face[i], face[(i + 1) % 3]}});
    const double bound = std::max(0., minimum_quality(mesh, change.removed_cells) + least_gain);
    if (!evaluate(mesh, bound, change))
      return {};
    return change;
  }
} // namespace retroforge
