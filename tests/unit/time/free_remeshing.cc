// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// What remeshing does to positions, differentiated. A quarter of a bulged cylinder under a bumpy ball that is pressed
// into its top is remeshed at positions and dies that are moved by little, everything decided anew. Proved: where that
// makes the same mesh, differences of the new positions converge to the derivative that the tape of the nominal
// remeshing gives, to 1e-7 of it: by the die's place, random vertices of the die, a growing radius, and random
// positions of all nodes. The reverse is the transpose of the tangent. Without the terms of the tape, by interpolation
// alone, the differences are off by more than 1e-2.

#include <deal.II/base/mpi.h>

#include "../geometry/geometry_test_tools.h"
#include "../random_numbers.h"
#include <retroforge/billet/billet.h>
#include <retroforge/time/remesher.h>

#include <cstdio>

using namespace retroforge;

namespace
{
  RandomNumbers random_numbers;

  constexpr double ball_radius = 30., height = 28., depth = 3., size = 8.;

  /// All that a remeshing depends on, or a direction of it.
  struct Point
  {
    NodalVectors<double> X;
    Vec3                 displacement;
    NodalVectors<double> vertices;
  };

  Point moved(Point at, const Point &direction, const double h)
  {
    for (std::size_t k = 0; k < at.X.size(); ++k)
      at.X[k] += h * direction.X[k];
    at.displacement += h * direction.displacement;
    for (std::size_t k = 0; k < at.vertices.size(); ++k)
      at.vertices[k] += h * direction.vertices[k];
    return at;
  }

  TetMesh quarter()
  {
    BilletParameters billet;
    billet.shape           = BilletParameters::Shape::cylinder;
    billet.radius          = 16.;
    billet.height          = 40.;
    billet.element_size    = size;
    billet.symmetry_planes = {Vec3({-1., 0., 0.}), Vec3({0., -1., 0.})};
    return make_billet(billet, MPI_COMM_WORLD);
  }

  struct Scene
  {
    TetMesh          mesh = quarter();
    std::vector<Die> dies;
    Point            at;

    Scene()
    {
      const TriangleSurface ball = bumpy_sphere(4);
      at.vertices                = ball.vertices();
      for (Vec3 &x : at.vertices)
        x = ball_radius * x + Vec3({0., 0., height + ball_radius - depth});
      dies.emplace_back("ball", TriangleSurface("ball", at.vertices, ball.triangles()), 10.);
      for (const Vec3 &x : mesh.X)
        at.X.push_back(pressed(bulged(x)));
    }

    /// With noise, so that no two edges are equally long.
    static Vec3 bulged(const Vec3 &x)
    {
      const double z = x[2] / 40., r = 1.1 + 0.6 * z * (1. - z) + 0.1 * std::sin(7. * z);
      Vec3         y({r * x[0], r * x[1], height * z});
      const Vec3   noise = 0.2 * random_numbers.vector();
      for (unsigned int i = 0; i < 3; ++i)
        if (y[i] > 1e-9 && !(i == 2 && z > 1. - 1e-9))
          y[i] += noise[i];
      return y;
    }

    Vec3 pressed(const Vec3 &x) const
    {
      const DieFeature feature = dies[0].closest(x, Vec3());
      if (!feature.found())
        return x;
      const auto p = dies[0].project(x, Vec3(), feature);
      return p.delta < 0. ? x + p.delta * p.n : x;
    }

    Point no_direction() const
    {
      return {NodalVectors<double>(at.X.size()), Vec3(), NodalVectors<double>(at.vertices.size())};
    }

    std::shared_ptr<const RemeshRecord> remesh(const Point &there) const
    {
      const std::vector<Die> dies_there = {dies[0].moved(there.vertices)};
      RemesherParameters     parameters;
      parameters.sizes = RemesherParameters::Sizes::uniform;
      const Remesher   remesher(parameters, size, dies_there, mesh.patches, MPI_COMM_WORLD);
      DieState<double> state;
      state.displacement = there.displacement;
      Timings timings;
      return remesher.remesh(mesh, there.X, {state}, {}, 0., timings);
    }

    NodalVectors<Dual> tangent(const RemeshRecord &record, const Point &direction) const
    {
      const auto         along = [](Dual &x, const double &d) { x.fastAccessDx(0) = d; };
      NodalVectors<Dual> X;
      DieState<Dual>     state;
      convert(at.X, X);
      convert(at.vertices, state.vertices);
      convert(at.displacement, state.displacement);
      for_each_number(along, X, direction.X);
      for_each_number(along, state.vertices, direction.vertices);
      for_each_number(along, state.displacement, direction.displacement);
      return record.positions.positions<Dual>({mesh, record.mesh, dies, {state}}, X);
    }
  };

  /// <A direction, y> - <direction, A^T y>, relative.
  double transpose_defect(const Scene &scene, const RemeshRecord &record, const Point &direction)
  {
    const NodalVectors<Dual>      tangent = scene.tangent(record, direction);
    const NodalVectors<double>    y       = random_numbers.vectors(tangent.size());
    NodalVectors<double>          X_bar(scene.at.X.size());
    std::vector<DieState<double>> bar(1);
    bar[0].vertices.resize(scene.at.vertices.size());
    const std::vector<DieState<double>> states(1);
    record.positions.reverse_positions(
      {scene.mesh, record.mesh, scene.dies, states}, scene.at.X, y, X_bar, bar);
    double forward = 0., length = 0.;
    for (std::size_t k = 0; k < y.size(); ++k)
      for (unsigned int i = 0; i < 3; ++i)
      {
        forward += y[k][i] * tangent[k][i].dx(0);
        length += std::abs(y[k][i] * tangent[k][i].dx(0));
      }
    const double reverse = dot(X_bar, direction.X) + bar[0].displacement * direction.displacement +
                           dot(bar[0].vertices, direction.vertices);
    return std::abs(forward - reverse) / length;
  }

  void compare(const Scene &scene, const RemeshRecord &record, const char *name, const Point &direction)
  {
    const NodalVectors<Dual>   tangent  = scene.tangent(record, direction);
    const NodalVectors<double> by_nodes = record.transfer.apply(direction.X);
    double                     largest = 0., error[2] = {0., 0.}, bare = 0.;
    bool                       same     = true;
    const double               steps[2] = {1e-4, 1e-5};
    for (unsigned int s = 0; s < 2; ++s)
    {
      const auto plus  = scene.remesh(moved(scene.at, direction, steps[s])),
                 minus = scene.remesh(moved(scene.at, direction, -steps[s]));
      same = same && plus->mesh.cells == record.mesh.cells && minus->mesh.cells == record.mesh.cells;
      for (NodeIndex k = 0; same && k < record.mesh.n_nodes(); ++k)
      {
        const Vec3 difference = (plus->mesh.X[k] - minus->mesh.X[k]) / (2. * steps[s]);
        Vec3       derivative;
        for (unsigned int i = 0; i < 3; ++i)
          derivative[i] = tangent[k][i].dx(0);
        largest  = std::max(largest, derivative.norm());
        error[s] = std::max(error[s], (difference - derivative).norm());
        bare     = std::max(bare, (difference - by_nodes[k]).norm());
      }
    }
    const auto yes = [](const bool condition) { return condition ? "yes" : "NO"; };
    std::printf("%s: the same mesh: %s, differences within 1e-7: %s, by interpolation alone off by 1e-2: %s, "
                "transpose: %s\n",
                name,
                yes(same),
                yes(std::max(error[0], error[1]) < 1e-7 * largest),
                yes(bare > 1e-2 * largest),
                yes(transpose_defect(scene, record, direction) < 1e-13));
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const Scene                              scene;
  const auto                               record = scene.remesh(scene.at);

  Point direction        = scene.no_direction();
  direction.displacement = Vec3({0.3, -0.2, -1.});
  compare(scene, *record, "the die's place", direction);
  direction = scene.no_direction();
  for (Vec3 &x : direction.vertices)
    x = random_numbers.vector();
  compare(scene, *record, "its vertices", direction);
  direction = scene.no_direction();
  for (std::size_t k = 0; k < direction.X.size(); ++k)
    direction.X[k] = Vec3({scene.at.X[k][0], scene.at.X[k][1], 0.}) / 16.;
  compare(scene, *record, "radius", direction);
  // Nodes stay in the planes of symmetry.
  for (std::size_t k = 0; k < direction.X.size(); ++k)
    for (unsigned int i = 0; i < 3; ++i)
      direction.X[k][i] = scene.mesh.X[k][i] > 1e-9 ? random_numbers.scalar() : 0.;
  compare(scene, *record, "positions", direction);
}
