// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/remeshing/peel.h>
#include <retroforge/remeshing/smoothing.h>

namespace retroforge
{
  std::optional<CavityChange> plan_peel(const RemeshingContext &context, const NodeIndex a, const NodeIndex b)
  {
    const EditableMesh &mesh  = context.mesh;
    const auto          cells = mesh.cells_at_edge(a, b);
    const auto          faces = mesh.faces_at_edge(a, b);
    if (cells.size() != 1 || faces.size() != 2 || mesh.curve_of_edge(a, b) != invalid_index ||
        mesh.cells_at(a).size() == 1 || mesh.cells_at(b).size() == 1)
      return {};
    const unsigned int region = mesh.face(faces[0]).region;
    if (mesh.face(faces[1]).region != region || !context.old_surface.planes_of_region(region).empty())
      return {};
    std::vector<NodeIndex> opposite;
    for (const NodeIndex node : mesh.cell(cells[0]))
      if (node != a && node != b)
        opposite.push_back(node);
    if (!mesh.faces_at_edge(opposite[0], opposite[1]).empty())
      return {};
    const auto depth = [&](const NodeIndex p, const NodeIndex q) {
      return context.old_surface.depth_in_dies((mesh.X(p) + mesh.X(q)) / 2.);
    };
    if (!(depth(opposite[0], opposite[1]) < depth(a, b)))
      return {};
    CavityChange change;
    change.removed_cells = cells;
    change.removed_faces = faces;
    for (const auto &face : cavity_of_edge(mesh, a, b))
      change.added_faces.push_back({face, region});
    return change;
  }
} // namespace retroforge
