// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// What must be refused, each next to a case that differs only in the reason and is done.
// - face flip of two cells whose union is not convex (the new edge passes outside: inverted cells);
// - surface flip over a ridge, and over a surface that turns too much or whose diagonals are too far apart;
// - collapse that pinches a triangular bar at its waist (the three edges of the waist bound no face);
// - collapse off a ridge, of a corner, and one that moves the surface or makes an edge too long;
// - remeshing of an inverted mesh, of a position that is no number; parameters that contradict each other.

#include <deal.II/base/mpi.h>

#include "remeshing_test_tools.h"
#include <retroforge/remeshing/collapse.h>
#include <retroforge/remeshing/edge_removal.h>
#include <retroforge/remeshing/face_flip.h>

#include <limits>

using namespace retroforge;

std::string done(const std::optional<CavityChange> &change)
{
  return change ? "done" : "refused";
}

// Apices over and under a triangle of radius 1; `aside` moves the upper one sideways.
void face_flips()
{
  for (const double aside : {0., 2.})
  {
    TetMesh mesh;
    mesh.X     = {Vec3({1, 0, 0}),
                  Vec3({-0.5, std::sqrt(0.75), 0}),
                  Vec3({-0.5, -std::sqrt(0.75), 0}),
                  Vec3({0, 0, -0.5}),
                  Vec3({aside, 0, 0.5})};
    mesh.cells = {{{0, 2, 1, 3}}, {{0, 1, 2, 4}}};
    add_one_patch(mesh);
    const Workbench bench(mesh, 1.);
    std::cout << "face flip, upper node aside by " << aside << ": "
              << done(plan_face_flip(bench.context, 0, 3, -2)) << "\n";
  }
}

// A flat cell 0-1-2-3 on top of a block: edge 0-1 is on the surface, 2-3 under it by `depth`. Its removal
// takes the cell away and leaves 2-3 as the edge of the surface.
TetMesh roof(const double depth)
{
  TetMesh mesh;
  mesh.X = {
    Vec3({-1, 0, 0}), Vec3({1, 0, 0}), Vec3({0, -1, -depth}), Vec3({0, 1, -depth}), Vec3({0, 0, -1.5})};
  mesh.cells = {{{0, 1, 2, 3}}, {{0, 2, 3, 4}}, {{1, 3, 2, 4}}};
  for (auto &cell : mesh.cells)
    if (tet_volume(corners(cell, mesh.X)) < 0)
      std::swap(cell[2], cell[3]);
  add_one_patch(mesh);
  return mesh;
}

void surface_flips()
{
  for (const double depth : {0.02, 0.09, 0.5})
  {
    const Workbench bench(roof(depth), 1.);
    std::cout << "flat cell of depth " << depth << " on the surface: removal of its edge "
              << done(plan_edge_removal(bench.context, 0, 1, -2)) << "\n";
  }
  TetMesh two_patches = roof(0.02);
  two_patches.patches.push_back({"other", {}});
  for (auto &face : two_patches.faces)
    if (contains(face.nodes, 0) && contains(face.nodes, 1) && contains(face.nodes, 2))
      face.patch = 1;
  const Workbench bench(two_patches, 1.);
  std::cout << "the same at depth 0.02 with two patches: " << done(plan_edge_removal(bench.context, 0, 1, -2))
            << "\n";
}

// Prisms of triangular section, three cells each, along z; all one smooth surface as far as angles go. One
// side of the section is short, so that collapsing it turns no face by much.
TetMesh triangular_bar(const unsigned int n)
{
  TetMesh mesh;
  for (unsigned int layer = 0; layer <= n; ++layer)
    for (const auto &[x, y] : {std::array<double, 2>{{1, -0.15}}, {{1, 0.15}}, {{-1, 0}}})
      mesh.X.push_back(Vec3({x, y, double(layer)}));
  for (unsigned int layer = 0; layer < n; ++layer)
  {
    const unsigned int b = 3 * layer, t = b + 3;
    mesh.cells.push_back({{b, b + 1, b + 2, t + 2}});
    mesh.cells.push_back({{b, b + 1, t + 2, t + 1}});
    mesh.cells.push_back({{b, t + 1, t + 2, t}});
  }
  for (auto &cell : mesh.cells)
    if (tet_volume(corners(cell, mesh.X)) < 0)
      std::swap(cell[2], cell[3]);
  add_one_patch(mesh);
  return mesh;
}

void pinches()
{
  RemeshingParameters loose;
  loose.ridge_angle = loose.corner_angle = 180;
  loose.surface_deviation                = 10;
  const Workbench     bench(triangular_bar(4), 1., loose);
  const EditableMesh &mesh = bench.edited;
  std::cout << "bar: " << verdict(bench.mesh) << ", smooth: " << yes(mesh.kind(6) == NodeKind::surface)
            << "\n";
  unsigned int n_done = 0;
  for (NodeIndex a = 0; a < mesh.n_nodes(); ++a)
    for (const NodeIndex b : mesh.neighbours(a))
      if (const auto change = plan_collapse(bench.context, a, b, 0, 10))
      {
        ++n_done;
        if (verdict(bench.after(*change)) != "valid")
          std::cout << "collapse " << a << " -> " << b << " breaks the bar\n";
      }
  std::cout << "collapses of the bar's nodes done: " << n_done << "\n";
}

void collapses()
{
  const Workbench     bench(kuhn_box(3, 0.), 1.);
  const EditableMesh &mesh = bench.edited;
  const auto          at   = [](const unsigned int i, const unsigned int j, const unsigned int k) {
    return i + 4 * (j + 4 * k);
  };
  const auto report =
    [&](const std::string &title, const NodeIndex a, const NodeIndex b, const double longest) {
      std::cout << title << " (edge: " << yes(mesh.is_edge(a, b))
                << "): " << done(plan_collapse(bench.context, a, b, 0, longest)) << "\n";
    };
  report("along a ridge", at(1, 0, 0), at(0, 0, 0), 10);
  report("off a ridge", at(1, 0, 0), at(1, 1, 0), 10);
  report("of a corner", at(0, 0, 0), at(1, 0, 0), 10);
  report("from the surface inwards", at(1, 1, 0), at(1, 1, 1), 10);
  report("from inside to the surface", at(1, 1, 1), at(1, 1, 0), 10);
  report("the same, edges up to 1.6", at(1, 1, 1), at(1, 1, 0), 1.6);

  // Two patches on the flat top, which meet in the line x = 1: only the patches tell that it is a ridge.
  TetMesh halves = kuhn_box(3, 0.);
  halves.patches.push_back({"other half", {}});
  for (auto &face : halves.faces)
    if (face.patch == 5 &&
        halves.X[face.nodes[0]][0] + halves.X[face.nodes[1]][0] + halves.X[face.nodes[2]][0] > 3)
      face.patch = 6;
  RemeshingParameters any_shape;
  any_shape.ridge_deviation = any_shape.surface_deviation = 10;
  const Workbench flat(halves, 1., any_shape);
  for (const auto &[i, j] : {std::array<unsigned int, 2>{{1, 2}}, {{2, 1}}, {{0, 1}}})
    std::cout << "flat ridge, node 1 1 to " << i << " " << j << ": "
              << done(plan_collapse(flat.context, at(1, 1, 3), at(i, j, 3), 0, 10)) << "\n";
  std::cout << "  to it, from 2 1: " << done(plan_collapse(flat.context, at(2, 1, 3), at(1, 1, 3), 0, 10))
            << "\n";

  for (const double height : {0.05, 0.3})
  {
    TetMesh bumpy = kuhn_box(4, 0.);
    bumpy.X[2 + 5 * 2 + 25 * 4][2] += height;
    const Workbench bump(bumpy, 1.);
    unsigned int    n_done = 0;
    for (const NodeIndex to : bump.edited.neighbours(112))
      n_done += plan_collapse(bump.context, 112, to, 0, 10).has_value();
    std::cout << "a bump of " << height << " h: collapses of its top done: " << n_done << "\n";
  }
}

void bad_input()
{
  const SizeField size = [](const Vec3 &) { return 1.; };
  TetMesh         mesh = kuhn_box(2, 0.);
  mesh.X[13]           = Vec3({3, 3, 3});
  print_error("inverted", [&]() { remesh_locally(mesh, mesh.X, size, {}); });
  mesh.X[13][1] = std::numeric_limits<double>::quiet_NaN();
  print_error("no number", [&]() { remesh_locally(mesh, mesh.X, size, {}); });
  RemeshingParameters parameters;
  parameters.goal_angle = 12;
  print_error("goal below trigger", [&]() { parameters.check(); });
  parameters               = {};
  parameters.shortest_edge = 0.9;
  print_error("halves are too short", [&]() { parameters.check(); });
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  face_flips();
  surface_flips();
  pinches();
  collapses();
  bad_input();
}
