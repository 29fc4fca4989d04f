// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The deepest point of a surface in a die, or of a die in the metal. Proved, with a block of edges 10 and
// elements of 5: a plane 0.3 above its base is reported 0.3 deep; of a roof that falls by 1 over 10, whose
// ridge passes midway between nodes at x = 0 and x = 5, 0.3 above the base, the ridge is found, 0.3 from the
// base, where middles of edges are 0.3 / sqrt(1.01) = 0.2985 deep, and no node deeper than (0.3 - 0.25) /
// sqrt(1.01) = 0.0498; a die away from the block is not reported.

#include <deal.II/base/mpi.h>

#include <retroforge/contact/penetration.h>

#include <cstdio>

#include "../mesh/block_mesh.h"

using namespace retroforge;

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  TetMesh mesh = block_mesh({{2, 2, 2}}, [](unsigned int, unsigned int, unsigned int) { return true; });
  for (Vec3 &x : mesh.X)
    x = 5. * x - Vec3({5., 5., 0.});
  const Topology topology(mesh);
  const auto     report = [&](const char *name, const Die &die, const double lift) {
    const std::vector<DieState<double>> states  = {{Vec3(), Vec3({0., 0., lift}), 0., {}}};
    const Penetration                   deepest = deepest_point(mesh, topology, {die}, states, mesh.X);
    std::printf("%s: %.4f deep, found %s\n", name, deepest.depth, deepest.die == 0 ? "yes" : "no");
    return deepest;
  };
  const Die plane("plane", Vec3(), Vec3({0., 0., 1.}));
  report("plane", plane, 0.3);
  report("plane below", plane, -0.3);
  // Two slopes that meet at x = 2.5, between nodes: they fall by 1 over 10.
  const NodalVectors<double>  x = {Vec3({-7.5, -20., -1.}),
                                   Vec3({2.5, -20., 0.}),
                                   Vec3({12.5, -20., -1.}),
                                   Vec3({-7.5, 20., -1.}),
                                   Vec3({2.5, 20., 0.}),
                                   Vec3({12.5, 20., -1.})};
  const std::vector<Triangle> t = {{{0, 1, 4}}, {{0, 4, 3}}, {{1, 2, 5}}, {{1, 5, 4}}};
  const Die                   roof("roof", TriangleSurface("roof", x, t), 3., {false, 40.});
  const Penetration           deepest = report("roof", roof, 0.3);
  double                      nodes   = 0.;
  for (const Vec3 &node : mesh.X)
    nodes = std::max(nodes, roof.depth_of(node, Vec3({0., 0., 0.3}), 5.));
  std::printf("  at x = %.1f, deepest node %.4f\n", deepest.place[0], nodes);
}
