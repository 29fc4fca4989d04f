// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The numbered edges of a mesh. By hand: one tetrahedron has its six edges in ascending order 01 02 03 12 13
// 23, its own order 01 12 20 03 13 23 is 0 3 1 2 4 5. On a block of 2 x 3 x 2 cubes, six tetrahedra each:
// Euler's formula  nodes - edges + faces - cells = 1  holds; edges ascend; those of cells and faces join
// their nodes; those of the surface are Topology's; what is no edge is not found.

#include "block_mesh.h"
#include "mesh_test_tools.h"
#include <retroforge/mesh/edges.h>
#include <retroforge/mesh/topology.h>

using namespace retroforge;

bool joins(const std::array<NodeIndex, 2> &edge, const NodeIndex a, const NodeIndex b)
{
  return edge[0] == std::min(a, b) && edge[1] == std::max(a, b);
}

bool cells_have_their_edges(const TetMesh &mesh, const MeshEdges &edges)
{
  bool right = edges.of_cells.size() == mesh.n_cells();
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    for (unsigned int e = 0; e < 6; ++e)
      right = right && joins(edges.nodes[edges.of_cells[c][e]],
                             mesh.cells[c][tet_edge_corners[e][0]],
                             mesh.cells[c][tet_edge_corners[e][1]]);
  return right;
}

bool faces_have_their_edges(const TetMesh &mesh, const MeshEdges &edges)
{
  bool right = edges.of_faces.size() == mesh.faces.size();
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (unsigned int i = 0; i < 3; ++i)
      right =
        right &&
        joins(edges.nodes[edges.of_faces[f][i]], mesh.faces[f].nodes[i], mesh.faces[f].nodes[(i + 1) % 3]);
  return right;
}

int main()
{
  TetMesh one;
  one.X     = {Vec3(), Vec3({1, 0, 0}), Vec3({0, 1, 0}), Vec3({0, 0, 1})};
  one.cells = {{{0, 1, 2, 3}}};
  const MeshEdges of_one(one);
  std::cout << "edges of a tetrahedron:";
  for (const auto &edge : of_one.nodes)
    std::cout << " " << edge[0] << edge[1];
  std::cout << ", in its order:";
  for (const EdgeIndex e : of_one.of_cells[0])
    std::cout << " " << e;

  const TetMesh mesh = block_mesh({{2, 3, 2}}, [](unsigned int, unsigned int, unsigned int) { return true; });
  const MeshEdges edges(mesh);
  const int       n_faces = (4 * mesh.n_cells() + mesh.faces.size()) / 2;
  std::cout << "\nEuler: "
            << static_cast<int>(mesh.n_nodes()) - static_cast<int>(edges.size()) + n_faces -
                 static_cast<int>(mesh.n_cells())
            << "\nascending: " << yes(std::is_sorted(edges.nodes.begin(), edges.nodes.end()))
            << "\nof cells: " << yes(cells_have_their_edges(mesh, edges))
            << "\nof faces: " << yes(faces_have_their_edges(mesh, edges));
  std::set<std::array<NodeIndex, 2>> of_surface;
  for (const auto &of_face : edges.of_faces)
    for (const EdgeIndex e : of_face)
      of_surface.insert(edges.nodes[e]);
  const auto expected = Topology(mesh).surface_edges;
  std::cout << "\nof the surface: "
            << yes(std::vector<std::array<NodeIndex, 2>>(of_surface.begin(), of_surface.end()) == expected)
            << "\nno edge: "
            << yes(edges.find(0, 0) == invalid_index && edges.find(0, mesh.n_nodes() - 1) == invalid_index)
            << std::endl;
}
