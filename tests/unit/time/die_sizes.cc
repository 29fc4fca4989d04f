// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The wanted length at a flat square of 40 x 40 mm, that ends where the workpiece goes on: the smallest at
// its rim, growing from there; but not at the side that lies in the workpiece's plane of symmetry, nor beyond
// it.

#include <deal.II/base/mpi.h>

#include <retroforge/time/remesher.h>

#include <cstdio>

using namespace retroforge;

namespace
{
  Die square()
  {
    const NodalVectors<double> x = {
      Vec3({0., -20., 0.}), Vec3({40., -20., 0.}), Vec3({40., 20., 0.}), Vec3({0., 20., 0.})};
    return Die("square", TriangleSurface("square", x, {{{0, 1, 2}}, {{0, 2, 3}}}), 5.);
  }

  void print(const char *title, const std::vector<Patch> &patches)
  {
    const std::vector<Die> dies = {square()};
    RemesherParameters     parameters; // growth 0.3, smallest size 0.2
    const Remesher         remesher(parameters, 5., dies, patches, MPI_COMM_WORLD);
    const auto             size = remesher.size_field({DieState<double>()});
    std::printf("%s: middle %.3g, rim at x = 40 %.3g, 3 mm before it %.3g, rim at x = 0 %.3g\n",
                title,
                size(Vec3({20., 0., 0.})),
                size(Vec3({40., 0., 0.})),
                size(Vec3({37., 0., 0.})),
                size(Vec3({0., 0., 0.})));
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  print("whole", {{"side", {}}});
  print("half", {{"side", {}}, {"plane", Plane{Vec3(), Vec3({-1., 0., 0.})}}});
}
