// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/billet/gmsh_mesher.h>
#include <retroforge/mesh/mesh_checks.h>
#include <retroforge/mesh/self_crossing.h>
#include <retroforge/remeshing/rebuild.h>

namespace retroforge
{
  RebuiltMesh rebuild_inside(const TetMesh                             &mesh,
                             const NodalVectors<double>                &X,
                             const std::function<double(const Vec3 &)> &size,
                             const std::string                         &where)
  {
    AssertDimension(X.size(), mesh.n_nodes());
    check_boundary_does_not_cross(mesh, X, where);
    std::vector<NodeIndex> new_node(mesh.n_nodes(), invalid_index);
    for (const auto &face : mesh.faces)
      for (const NodeIndex node : face.nodes)
        new_node[node] = 0;
    RebuiltMesh          rebuilt;
    NodalVectors<double> surface_X;
    for (NodeIndex node = 0; node < mesh.n_nodes(); ++node)
      if (new_node[node] != invalid_index)
      {
        new_node[node] = surface_X.size();
        surface_X.push_back(X[node]);
        rebuilt.old_node.push_back(node);
      }
    std::vector<BoundaryFace>             faces = mesh.faces;
    std::vector<std::array<NodeIndex, 3>> triangles;
    for (auto &face : faces)
    {
      for (NodeIndex &node : face.nodes)
        node = new_node[node];
      triangles.push_back(face.nodes);
    }
    rebuilt.mesh         = fill_with_gmsh(surface_X, triangles, size, where);
    rebuilt.mesh.faces   = faces;
    rebuilt.mesh.patches = mesh.patches;
    rebuilt.old_node.resize(rebuilt.mesh.n_nodes(), invalid_index);
    check_mesh(rebuilt.mesh, where);
    return rebuilt;
  }
} // namespace retroforge
