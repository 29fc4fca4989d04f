// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Lists of neighbours on an eighth of a cube (three symmetry planes) and on sectors. Proved: each surface
// face appears at its three nodes and no symmetry face does; each cell appears at its four nodes, and the cell of a
// face has its nodes; neighbours
// are symmetric, sorted and include the node; Euler's formula  nodes - edges + faces - cells = 1  of a ball
// holds; the fixed directions are orthonormal and span the normals of all planes the node is on; three of
// them has only the corner at the centre of the cube, and one node on the axis of the half sector. By hand, a
// tetrahedron with two planes through its edge 0-3: nodes 0 and 3 have two directions, 1 and 2 one; in the
// whole the edge 1-2 stands twice at its nodes, and those on one plane stand twice where the planes meet.

#include <deal.II/base/mpi.h>

#include "mesh_test_tools.h"
#include <retroforge/mesh/cell_faces.h>
#include <retroforge/mesh/topology.h>

#include <algorithm>

using namespace retroforge;

unsigned int count(const Topology &topology, const unsigned int n_fixed)
{
  unsigned int n = 0;
  for (unsigned int node = 0; node < topology.fixed_directions.size(); ++node)
    n += topology.fixed_directions[node].size() == n_fixed;
  return n;
}

bool faces_at_nodes_are_right(const TetMesh &mesh, const Topology &topology)
{
  std::size_t n = 0;
  for (unsigned int f = 0; f < mesh.faces.size(); ++f)
    for (const NodeIndex node : mesh.faces[f].nodes)
    {
      const auto at      = topology.surface_faces[node];
      const bool is_here = std::find(at.begin(), at.end(), f) != at.end();
      n += is_here;
      if (is_here != mesh.is_surface(mesh.faces[f]))
        return false;
    }
  return n == topology.surface_faces.entries.size();
}

bool cells_at_nodes_are_right(const TetMesh &mesh, const Topology &topology)
{
  for (NodeIndex node = 0; node < mesh.n_nodes(); ++node)
    for (const CellIndex c : topology.cells[node])
      if (std::find(mesh.cells[c].begin(), mesh.cells[c].end(), node) == mesh.cells[c].end())
        return false;
  return topology.cells.entries.size() == 4 * mesh.cells.size();
}

bool neighbours_are_right(const TetMesh &mesh, const Topology &topology)
{
  const auto has = [&](const NodeIndex a, const NodeIndex b) {
    return std::binary_search(topology.neighbours[a].begin(), topology.neighbours[a].end(), b);
  };
  for (NodeIndex a = 0; a < mesh.n_nodes(); ++a)
  {
    if (!has(a, a) || !std::is_sorted(topology.neighbours[a].begin(), topology.neighbours[a].end()))
      return false;
    for (const NodeIndex b : topology.neighbours[a])
      if (!has(b, a))
        return false;
  }
  return true;
}

double orthonormality_defect(const Topology &topology)
{
  double defect = 0;
  for (unsigned int node = 0; node < topology.fixed_directions.size(); ++node)
    for (const Vec3 &a : topology.fixed_directions[node])
      for (const Vec3 &b : topology.fixed_directions[node])
        defect = std::max(defect, std::abs(a * b - (&a == &b ? 1. : 0.)));
  return defect;
}

// Largest part of a symmetry face's normal that the directions of its nodes leave free.
double span_defect(const TetMesh &mesh, const Topology &topology)
{
  double defect = 0;
  for (const auto &face : mesh.faces)
    if (!mesh.is_surface(face))
      for (const NodeIndex node : face.nodes)
      {
        Vec3 rest = mesh.patches[face.patch].symmetry->normal;
        for (const Vec3 &direction : topology.fixed_directions[node])
          rest -= (rest * direction) * direction;
        defect = std::max(defect, rest.norm());
      }
  return defect;
}

bool cells_of_faces_are_right(const TetMesh &mesh, const Topology &topology)
{
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (const NodeIndex k : mesh.faces[f].nodes)
      if (const auto &cell = mesh.cells[topology.cell_of_face[f]];
          std::find(cell.begin(), cell.end(), k) == cell.end())
        return false;
  return topology.cell_of_face.size() == mesh.faces.size();
}

void report(const std::string &title, const TetMesh &mesh)
{
  const Topology topology(mesh);
  const int      n_edges = (topology.neighbours.entries.size() - mesh.n_nodes()) / 2;
  const int      n_faces = (4 * mesh.n_cells() + mesh.faces.size()) / 2;
  std::cout << title << "\n  faces at nodes: " << yes(faces_at_nodes_are_right(mesh, topology))
            << "\n  cells at nodes: " << yes(cells_at_nodes_are_right(mesh, topology))
            << "\n  cells of faces: " << yes(cells_of_faces_are_right(mesh, topology))
            << "\n  neighbours: " << yes(neighbours_are_right(mesh, topology)) << "\n  Euler: "
            << static_cast<int>(mesh.n_nodes()) - n_edges + n_faces - static_cast<int>(mesh.n_cells())
            << "\n  directions orthonormal: " << yes(orthonormality_defect(topology) < 1e-14)
            << "\n  normals spanned: " << yes(span_defect(mesh, topology) < 1e-14)
            << "\n  nodes with three directions: " << count(topology, 3)
            << "\n  some with none, one, two: " << yes(count(topology, 0) > 0) << " "
            << yes(count(topology, 1) > 0) << " " << yes(count(topology, 2) > 0) << "\n";
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  report("eighth of a cube",
         billet({{"element size", "8"},
                 {"symmetry planes", "-1, 0, 0; 0, -1, 0; 0, 0, 1"},
                 {"symmetry point", "centre"}}));
  report("sector of 60 degrees",
         billet({{"shape", "cylinder"}, {"element size", "8"}, {"sector angle", "60"}}));
  report("lower half of it",
         billet({{"shape", "cylinder"},
                 {"element size", "8"},
                 {"sector angle", "60"},
                 {"symmetry planes", "0, 0, 1"},
                 {"symmetry point", "centre"}}));

  TetMesh mesh;
  mesh.X       = {Vec3(), Vec3({1, 0, 0}), Vec3({0, 1, 0}), Vec3({0, 0, 1})};
  mesh.cells   = {{{0, 1, 2, 3}}};
  mesh.patches = {
    {"xz", Plane{Vec3(), Vec3({0, -1, 0})}}, {"yz", Plane{Vec3(), Vec3({-1, 0, 0})}}, {"rest", {}}};
  for (const auto &face : boundary_cell_faces(mesh.cells))
    mesh.faces.push_back(
      {face.nodes, face.key[0] == 0 && face.key[2] == 3 ? (face.key[1] == 1 ? 0u : 1u) : 2u});
  const Topology topology(mesh);
  std::cout << "one tetrahedron, directions at its nodes:";
  for (NodeIndex node = 0; node < 4; ++node)
    std::cout << " " << topology.fixed_directions[node].size();
  std::cout << ", surface faces:";
  for (NodeIndex node = 0; node < 4; ++node)
    std::cout << " " << topology.surface_faces[node].size();
  std::cout << "\nimages of its surface edges at their ends:";
  for (std::size_t e = 0; e < topology.surface_edges.size(); ++e)
    std::cout << " " << topology.surface_edges[e][0] << "-" << topology.surface_edges[e][1] << ": "
              << topology.edge_images[e][0] << " " << topology.edge_images[e][1]
              << (e + 1 < topology.surface_edges.size() ? "," : "\n");
}
