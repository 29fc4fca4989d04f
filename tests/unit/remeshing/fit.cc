// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Metal that has been drawn around the edge of a die: the ends of long surface edges are outside the
// rounding, their middles deep inside it, and nodes of the next layer lie where the new surface should be.
// Proved: every new node reaches the die, no surface edge is deeper in it than the wanted length allows,
// cells are sound.

#include <deal.II/base/mpi.h>

#include "remeshing_test_tools.h"
#include <retroforge/remeshing/length_pass.h>
#include <retroforge/remeshing/peel.h>

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

void drawn_over_an_edge()
{
  const TetMesh             mesh = drawn_box();
  const SizeField           size = [](const Vec3 &) { return 2.5; };
  const RemeshingParameters parameters;
  const SurfaceFeatures     features(mesh, mesh.X, parameters.ridge_angle, parameters.corner_angle);
  const OldSurface          old_surface(mesh, mesh.X, features, leave);
  EditableMesh              edited(mesh, mesh.X, features);
  RemeshingContext          context = {edited, old_surface, size, parameters};
  RemeshingReport           report;
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

// Two faces of the top become a valley, bridged by one more cell; the die comes down into that.
void bridged_valley()
{
  TetMesh    mesh     = kuhn_box(3, 0.);
  const auto opposite = [](const BoundaryFace &face, const std::array<NodeIndex, 2> &edge) {
    return *std::find_if(
      face.nodes.begin(), face.nodes.end(), [&](const NodeIndex k) { return !contains(edge, k); });
  };
  NodeIndex a = invalid_index, b = invalid_index;
  for (const auto &edge : surface_edges(mesh.faces))
  {
    const BoundaryFace &f = mesh.faces[edge.faces[0]], &g = mesh.faces[edge.faces[1]];
    const Vec3          middle = (mesh.X[edge.nodes[0]] + mesh.X[edge.nodes[1]]) / 2.;
    if ((middle - Vec3({1.5, 1.5, 3})).norm() > 0.1)
      continue;
    a = opposite(f, edge.nodes);
    b = opposite(g, edge.nodes);
    mesh.cells.push_back({{a, b, edge.nodes[0], edge.nodes[1]}});
  }
  mesh.X[a][2] += 0.3;
  mesh.X[b][2] += 0.3;
  Cell &bridge = mesh.cells.back();
  if (tet_volume(corners(bridge, mesh.X)) < 0)
    std::swap(bridge[2], bridge[3]);
  const double bridge_volume = tet_volume(corners(bridge, mesh.X));
  add_one_patch(mesh);

  const RemeshingParameters parameters;
  const PushOut             above = [](const Vec3 &x) { return Vec3({x[0], x[1], std::min(x[2], 3.05)}); };
  const SurfaceFeatures     features(mesh, mesh.X, parameters.ridge_angle, parameters.corner_angle, above);
  const OldSurface          old_surface(mesh, mesh.X, features, above);
  const SizeField           size = [](const Vec3 &) { return 1.; };
  EditableMesh              edited(mesh, mesh.X, features);
  const RemeshingContext    context  = {edited, old_surface, size, parameters};
  unsigned int              n_others = 0;
  for (const auto &edge : surface_edges(mesh.faces))
    if (!contains(edge.nodes, a) || !contains(edge.nodes, b))
      n_others += plan_peel(context, edge.nodes[0], edge.nodes[1]).has_value();
  const auto change = plan_peel(context, a, b);
  std::cout << "a cell in the die: peeled off: " << yes(change.has_value()) << ", others: " << n_others;
  if (change)
  {
    edited.apply(*change);
    std::vector<NodeIndex> old_node;
    TetMesh                after = compacted(edited, features, old_node);
    after.patches                = mesh.patches;
    const double lost            = volume(mesh.cells, mesh.X) - volume(after.cells, after.X);
    std::cout << ", " << verdict(after)
              << ", its volume is gone: " << yes(std::abs(lost - bridge_volume) < 1e-12);
  }
  std::cout << "\n";
}

int main(int argc, char **argv)
{
  measured(argc > 1);
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  drawn_over_an_edge();
  bridged_valley();
}
