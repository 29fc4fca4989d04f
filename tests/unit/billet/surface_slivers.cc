// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Slivers on the surface. A block of unit cubes with a tetrahedron of height 0.02 on the square of one: two
// of its corners are lifted by 0.01, the other two lowered, so that its angles are 2.3 degrees.
// Proved: it goes, and what is left is the block as it was, cells, faces and patches, and the nodes are as
// many; it stays when the limit is below its angle, when its two faces are of two patches, and when they are
// in a plane of symmetry; one whose other diagonal is an edge of the boundary already, between two cells that
// else only share this edge, stays.

#include <retroforge/billet/surface_slivers.h>

#include "../mesh/block_mesh.h"
#include "../mesh/mesh_test_tools.h"

using namespace retroforge;

namespace
{
  NodeIndex node_at(const TetMesh &mesh, const double x, const double y, const double z)
  {
    for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
      if ((mesh.X[k] - Vec3({x, y, z})).norm() < 0.1)
        return k;
    return invalid_index;
  }

  TetMesh block()
  {
    return block_mesh({{4, 3, 2}}, [](unsigned int, unsigned int, unsigned int) { return true; });
  }

  // On the top of the cube at (i, 1), whose diagonal runs from (i, 1) to (i + 1, 2).
  void add_sliver(TetMesh &mesh, const unsigned int i)
  {
    const NodeIndex a = node_at(mesh, i, 1, 2), b = node_at(mesh, i + 1, 2, 2),
                    c = node_at(mesh, i + 1, 1, 2), d = node_at(mesh, i, 2, 2);
    for (const NodeIndex k : {a, b})
      mesh.X[k][2] = 1.99;
    for (const NodeIndex k : {c, d})
      mesh.X[k][2] = 2.01;
    mesh.cells.push_back({{a, c, b, d}});
    const std::set<NodeIndex> four = {a, b, c, d};
    mesh.faces.erase(std::remove_if(mesh.faces.begin(),
                                    mesh.faces.end(),
                                    [&](const BoundaryFace &face) {
                                      return std::all_of(
                                        face.nodes.begin(), face.nodes.end(), [&](const NodeIndex k) {
                                          return four.count(k) > 0;
                                        });
                                    }),
                     mesh.faces.end());
    mesh.faces.push_back({{{a, c, d}}, 0});
    mesh.faces.push_back({{{c, b, d}}, 0});
  }

  std::map<FaceKey, unsigned int> patches_of_faces(const TetMesh &mesh)
  {
    std::map<FaceKey, unsigned int> patch;
    for (const BoundaryFace &face : mesh.faces)
      patch[face_key(face.nodes)] = face.patch;
    return patch;
  }

  bool same_but_positions(const TetMesh &a, const TetMesh &b)
  {
    return a.cells == b.cells && a.faces.size() == b.faces.size() &&
           patches_of_faces(a) == patches_of_faces(b) && a.n_nodes() == b.n_nodes();
  }

  void report(const std::string &title, TetMesh mesh, const double limit)
  {
    const TetMesh      before = mesh;
    const unsigned int n      = take_away_surface_slivers(mesh, limit);
    std::cout << title << ": " << n << " went, "
              << (same_but_positions(mesh, before) ? "all is as it was" : "")
              << (same_but_positions(mesh, block()) ? "the block is left" : "") << "; ";
    print_error("mesh", [&]() { check_mesh(mesh, "mesh"); });
  }
} // namespace

int main()
{
  TetMesh one = block();
  add_sliver(one, 1);
  std::cout << "angle between 2 and 3 degrees: "
            << yes(minimum_dihedral_angle(one.cells, one.X) > 2 &&
                   minimum_dihedral_angle(one.cells, one.X) < 3)
            << "\n";
  report("one", one, 15);
  report("limit below its angle", one, 2);

  TetMesh ridge            = one;
  ridge.faces.back().patch = 1;
  report("faces of two patches", ridge, 15);

  TetMesh symmetry             = one;
  symmetry.patches[0].symmetry = Plane{Vec3({0, 0, 2}), Vec3({0, 0, 1})};
  report("in a plane of symmetry", symmetry, 15);

  TetMesh two;
  two.X       = {Vec3({0, 0, 0}),
                 Vec3({1, 1, 0}),
                 Vec3({1, 0, 0.02}),
                 Vec3({0, 1, 0.02}),
                 Vec3({1, 0, -1}),
                 Vec3({0, 1, -1})};
  two.cells   = {{{0, 2, 1, 3}}, {{0, 1, 2, 4}}, {{0, 3, 1, 5}}};
  two.patches = {{"surface", {}}};
  for (const CellFace &face : boundary_cell_faces(two.cells))
    two.faces.push_back({face.nodes, 0});
  std::cout << "cells of positive volume: " << yes(minimum_quality(two.cells, two.X) > 0)
            << "\nother diagonal on the boundary: " << take_away_surface_slivers(two, 15) << " went\n";
}
