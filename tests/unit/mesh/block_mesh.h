// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/cell_faces.h>
#include <retroforge/mesh/renumber.h>
#include <retroforge/mesh/tet_mesh.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>

namespace retroforge
{
  /// Unit cubes of a grid, each cut into six tetrahedra along its main diagonal (Kuhn): those that `wanted`
  /// says, from (0, 0, 0) to (n[0], n[1], n[2]). Faces at z = n[2] are of the patch `top`, others of `side`.
  inline TetMesh block_mesh(const std::array<unsigned int, 3>                                   &n,
                            const std::function<bool(unsigned int, unsigned int, unsigned int)> &wanted)
  {
    TetMesh                                          mesh;
    std::map<std::array<unsigned int, 3>, NodeIndex> number;
    const auto                                       node = [&](const std::array<unsigned int, 3> &p) {
      const auto [found, is_new] = number.insert({p, mesh.X.size()});
      if (is_new)
        mesh.X.push_back(Vec3({double(p[0]), double(p[1]), double(p[2])}));
      return found->second;
    };
    // The order in which the axes are walked from corner to corner, and whether it is an even one.
    constexpr unsigned int walks[6][4] = {
      {0, 1, 2, 1}, {1, 2, 0, 1}, {2, 0, 1, 1}, {0, 2, 1, 0}, {2, 1, 0, 0}, {1, 0, 2, 0}};
    for (unsigned int i = 0; i < n[0]; ++i)
      for (unsigned int j = 0; j < n[1]; ++j)
        for (unsigned int k = 0; k < n[2]; ++k)
          if (wanted(i, j, k))
            for (const auto &walk : walks)
            {
              std::array<unsigned int, 3> p    = {{i, j, k}};
              std::array<NodeIndex, 4>    cell = {{node(p), 0, 0, 0}};
              for (unsigned int s = 0; s < 3; ++s)
              {
                ++p[walk[s]];
                cell[s + 1] = node(p);
              }
              if (walk[3] == 0)
                std::swap(cell[2], cell[3]);
              mesh.cells.push_back(cell);
            }
    mesh.patches = {{"top", {}}, {"side", {}}};
    for (const CellFace &face : boundary_cell_faces(mesh.cells))
    {
      bool top = true;
      for (const NodeIndex a : face.nodes)
        top = top && mesh.X[a][2] == n[2];
      mesh.faces.push_back({face.nodes, top ? 0u : 1u});
    }
    return mesh;
  }

  /// Half of a box, 0 <= x <= size[0] / 2, |y| <= size[1] / 2, 0 <= z <= size[2], of n[0] x n[1] x n[2] such
  /// blocks, with a plane of symmetry at x = 0: a billet whose mesh no generator decides.
  inline TetMesh half_box_mesh(const Vec3 &size, const std::array<unsigned int, 3> &n)
  {
    TetMesh mesh = block_mesh(n, [](unsigned int, unsigned int, unsigned int) { return true; });
    for (Vec3 &x : mesh.X)
      x = Vec3({x[0] / n[0] * size[0] / 2., (x[1] / n[1] - 0.5) * size[1], x[2] / n[2] * size[2]});
    mesh.patches.push_back({"symmetry 1", Plane{Vec3(), Vec3({-1., 0., 0.})}});
    for (BoundaryFace &face : mesh.faces)
      if (std::all_of(
            face.nodes.begin(), face.nodes.end(), [&](const NodeIndex k) { return mesh.X[k][0] == 0.; }))
        face.patch = 2;
    renumber(mesh);
    return mesh;
  }
} // namespace retroforge
