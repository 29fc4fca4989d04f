// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// check_mesh() refuses each kind of broken mesh, and names the place. The meshes are one or two tetrahedra
// spoilt in one way; those at the top are sound and pass.

#include "../mesh/mesh_test_tools.h"
#include <retroforge/mesh/cell_faces.h>

#include <limits>

using namespace retroforge;

TetMesh with_boundary(const NodalVectors<double> &X, const std::vector<std::array<NodeIndex, 4>> &cells)
{
  TetMesh mesh;
  mesh.X       = X;
  mesh.cells   = cells;
  mesh.patches = {{"all", {}}};
  for (const auto &face : boundary_cell_faces(cells))
    mesh.faces.push_back({face.nodes, 0});
  return mesh;
}

int main()
{
  const Vec3 o({0, 0, 0}), x({1, 0, 0}), y({0, 1, 0}), z({0, 0, 1});

  const TetMesh one = with_boundary({o, x, y, z}, {{{0, 1, 2, 3}}});
  const TetMesh two = with_boundary({o, x, y, z, -1. * z}, {{{0, 1, 2, 3}}, {{0, 2, 1, 4}}});
  print_error("one tetrahedron", [&]() { check_mesh(one, "mesh"); });
  print_error("two tetrahedra", [&]() { check_mesh(two, "mesh"); });

  const auto spoilt = [](TetMesh mesh, const auto &spoil) {
    spoil(mesh);
    return mesh;
  };
  print_error("no tetrahedra", [&]() { check_mesh(TetMesh(), "mesh"); });
  print_error("wrong node",
              [&]() { check_mesh(spoilt(one, [](TetMesh &m) { m.cells[0][2] = 9; }), "mesh"); });
  print_error("wrong node in a face",
              [&]() { check_mesh(spoilt(one, [](TetMesh &m) { m.faces[2].nodes[1] = 4; }), "mesh"); });
  print_error("wrong patch",
              [&]() { check_mesh(spoilt(one, [](TetMesh &m) { m.faces[1].patch = 1; }), "mesh"); });
  print_error("not a number", [&]() {
    check_mesh(spoilt(one, [](TetMesh &m) { m.X[3][1] = std::numeric_limits<double>::infinity(); }), "mesh");
  });
  print_error("inverted", [&]() { check_mesh(with_boundary({o, x, z, y}, {{{0, 1, 2, 3}}}), "mesh"); });
  print_error("degenerate", [&]() { check_mesh(with_boundary({o, x, y, x + y}, {{{0, 1, 2, 3}}}), "mesh"); });
  print_error("unused node",
              [&]() { check_mesh(spoilt(one, [](TetMesh &m) { m.X.push_back(Vec3()); }), "mesh"); });
  print_error("three at a face", [&]() {
    check_mesh(
      with_boundary({o, x, y, z, -1. * z, -2. * z}, {{{0, 1, 2, 3}}, {{0, 2, 1, 4}}, {{0, 2, 1, 5}}}),
      "mesh");
  });
  print_error("overlap", [&]() {
    check_mesh(with_boundary({o, x, y, z, 2. * z}, {{{0, 1, 2, 3}}, {{0, 1, 2, 4}}}), "mesh");
  });
  print_error("face missing",
              [&]() { check_mesh(spoilt(one, [](TetMesh &m) { m.faces.pop_back(); }), "mesh"); });
  print_error("face twice",
              [&]() { check_mesh(spoilt(one, [](TetMesh &m) { m.faces.push_back(m.faces[0]); }), "mesh"); });
  print_error("face turned", [&]() {
    check_mesh(spoilt(one, [](TetMesh &m) { std::swap(m.faces[0].nodes[0], m.faces[0].nodes[1]); }), "mesh");
  });
  print_error("face inside", [&]() {
    check_mesh(spoilt(two, [](TetMesh &m) { m.faces.push_back({{{0, 1, 2}}, 0}); }), "mesh");
  });
  print_error("joined at an edge", [&]() {
    check_mesh(with_boundary({o, x, y, z, -1. * y, -1. * z}, {{{0, 1, 2, 3}}, {{0, 1, 4, 5}}}), "mesh");
  });
  print_error("joined at a node", [&]() {
    check_mesh(with_boundary({o, x, y, z, -1. * x, -1. * y, -1. * z}, {{{0, 1, 2, 3}}, {{0, 5, 4, 6}}}),
               "mesh");
  });
  const Vec3 far = 9. * x;
  print_error("two bodies", [&]() {
    check_mesh(with_boundary({o, x, y, z, far, far + x, far + y, far + z}, {{{0, 1, 2, 3}}, {{4, 5, 6, 7}}}),
               "mesh");
  });
  print_error("twice in one place", [&]() {
    check_mesh(with_boundary({o, x, y, z, o, x, y, z}, {{{0, 1, 2, 3}}, {{4, 5, 6, 7}}}), "mesh");
  });
}
