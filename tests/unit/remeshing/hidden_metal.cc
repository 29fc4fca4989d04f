// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Surface next to the sharp edge of a die, which no operation may lay across it. The top of a box is a valley of
// slope s at x = 2, and the edge of the die above lies in it, or `higher`. Proved:
// - a node of the valley that its flat cells drive away from it is smoothed where the die is not there or higher,
//   and stays where the chords over its edge would be deeper in it than a tenth of the wanted length;
// - a collapse that takes a node of a flatter valley out of it leaves chords 0.09 deep in the die, which is allowed,
//   and is refused where they were 0.02 deep before and would be 0.11;
// - where they are 0.2 deep already, a collapse along the valley, which leaves them so, is allowed.

#include <deal.II/base/mpi.h>

#include "remeshing_test_tools.h"
#include <retroforge/remeshing/collapse.h>
#include <retroforge/remeshing/smoothing.h>

using namespace retroforge;

namespace
{
  constexpr unsigned int n = 4;

  struct Valley
  {
    double slope;
    bool   crowded = false; ///< two nodes on its side are next to one on its ground
  };

  TetMesh box_with(const Valley &valley)
  {
    TetMesh mesh = kuhn_box(n, 0.);
    for (Vec3 &x : mesh.X)
    {
      if (valley.crowded && x[0] == 1. && x[1] == 2. && x[2] >= n - 1)
        x[0] = 1.75;
      if (x[2] == n)
        x[2] += valley.slope * std::abs(x[0] - 2.);
    }
    return mesh;
  }

  /// Out of a die whose surface is the valley's, or higher.
  PushOut die_in(const Valley &valley, const double higher)
  {
    return [=](const Vec3 &x) {
      const double side = x[0] < 2. ? -1. : 1., length = std::hypot(1., valley.slope);
      const double depth = (x[2] - n - higher - valley.slope * std::abs(x[0] - 2.)) / length;
      return depth > 0. ? x - depth / length * Vec3({-side * valley.slope, 0., 1.}) : x;
    };
  }

  /// A node on the valley's ground, and what may be done to it.
  struct Ground
  {
    TetMesh             mesh;
    RemeshingParameters parameters;
    SurfaceFeatures     features;
    OldSurface          old_surface;
    EditableMesh        edited;
    SizeField           size;
    RemeshingContext    context;
    NodeIndex           node, aside, along; ///< on the ground, and neighbours of it

    Ground(const Valley &valley, const PushOut &push_out, const double h)
        : mesh(box_with(valley))
        , features(mesh, mesh.X, parameters.ridge_angle, parameters.corner_angle)
        , old_surface(mesh, mesh.X, features, push_out)
        , edited(mesh, mesh.X, features)
        , size([h](const Vec3 &) { return h; })
        , context{edited, old_surface, size, parameters}
        , node(at(2., 2.))
        , aside(at(1., 2.))
        , along(at(2., 1.))
    {
    }
    Ground(const Ground &) = delete;

    NodeIndex at(const double x, const double y) const
    {
      return std::find_if(mesh.X.begin(),
                          mesh.X.end(),
                          [&](const Vec3 &p) { return p[0] == x && p[1] == y && p[2] >= n; }) -
             mesh.X.begin();
    }
  };

  void smooth(const std::string &title, const PushOut &push_out)
  {
    const Ground ground({0.33, true}, push_out, 0.1);
    const auto   change = plan_smoothing(ground.context, ground.node, 1e-3);
    std::cout << title << ": smoothed: " << yes(change.has_value()) << "\n";
    if (change)
      measured() << change->position << " " << change->gain() << "\n";
  }

  void collapse(const std::string &title, const PushOut &push_out)
  {
    const Ground ground({0.09}, push_out, 1.);
    const auto   to = [&](const NodeIndex end) {
      return yes(plan_collapse(ground.context, ground.node, end, 0., 10.).has_value());
    };
    std::cout << title << ": collapsed aside: " << to(ground.aside) << ", along: " << to(ground.along)
              << "\n";
  }
} // namespace

int main(int argc, char **argv)
{
  measured(argc > 1);
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const Valley                             steep = {0.33, true}, flat = {0.09};
  smooth("no die", {});
  smooth("a die higher by 1", die_in(steep, 1.));
  smooth("a die", die_in(steep, 0.));
  collapse("no die", {});
  collapse("a die", die_in(flat, 0.));
  collapse("a die lower by 0.02", die_in(flat, -0.02));
  collapse("a die lower by 0.2", die_in(flat, -0.2));
}
