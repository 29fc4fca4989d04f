// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Metal that has been drawn around the edge of a die: the ends of long surface edges are outside the
// rounding, their middles deep inside it, and nodes of the next layer lie where the new surface should be.
// Proved: every new node reaches the die, no surface edge is deeper in it than the wanted length allows,
// cells are sound.

#include <deal.II/base/mpi.h>

#include "remeshing_test_tools.h"
#include <retroforge/mesh/remeshing/length_pass.h>

using namespace retroforge;

// The rounding: a cylinder along y of radius 4 that reaches 1.5 into the top of the box.
constexpr double radius = 4;
const Vec3       axis({0, 0, 15});

double depth(const Vec3 &x)
{
  return radius - std::hypot(x[0] - axis[0], x[2] - axis[2]);
}

Vec3 leave(const Vec3 &x)
{
  Vec3 way({x[0] - axis[0], 0, x[2] - axis[2]});
  return depth(x) > 0 ? x + (depth(x) / way.norm()) * way : x;
}

// Edges of length 7 across the rounding, their ends just outside it; the next layer is 1 below it.
TetMesh drawn_box()
{
  TetMesh mesh = kuhn_box(5, 0.);
  for (Vec3 &x : mesh.X)
    x = Vec3({7 * (x[0] - 2.5), 3 * x[1], 2.5 * x[2]});
  return mesh;
}

double deepest_edge(const TetMesh &mesh)
{
  double deepest = 0;
  for (const auto &face : mesh.faces)
    if (mesh.patches[face.patch].name == "z1")
      for (unsigned int e = 0; e < 3; ++e)
        deepest = std::max(deepest, depth((mesh.X[face.nodes[e]] + mesh.X[face.nodes[(e + 1) % 3]]) / 2.));
  return deepest;
}

int main(int argc, char **argv)
{
  measured(argc > 1);
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const TetMesh                            mesh = drawn_box();
  const SizeField                          size = [](const Vec3 &) { return 2.5; };
  const RemeshingParameters                parameters;
  const SurfaceFeatures features(mesh, mesh.X, parameters.ridge_angle, parameters.corner_angle);
  const OldSurface      old_surface(mesh, mesh.X, features, leave);
  EditableMesh          edited(mesh, mesh.X, features);
  RemeshingContext      context = {edited, old_surface, size, parameters};
  RemeshingReport       report;
  length_pass(context, report);

  std::vector<NodeIndex> old_node;
  TetMesh                after = compacted(edited, features, old_node);
  after.patches                = mesh.patches;
  double node                  = 0;
  for (const auto &face : after.faces)
    for (const NodeIndex k : face.nodes)
      node = std::max(node, depth(after.X[k]));
  // The chord of the longest edge allowed, 1.6 h: l^2/(8 r) = 0.5.
  std::cout << "before: edges deeper than 1: " << yes(deepest_edge(mesh) > 1) << "\n"
            << "after: no node inside the die: " << yes(node < 1e-2)
            << ", edges no deeper than their length allows: " << yes(deepest_edge(after) < 0.5) << ", "
            << verdict(after) << ", quality above 0.05: " << yes(minimum_quality(after.cells, after.X) > 0.05)
            << "\n";
  measured() << deepest_edge(mesh) << " " << deepest_edge(after) << " " << node << " "
             << minimum_quality(after.cells, after.X) << " " << report.n_length_splits << "\n";
}
