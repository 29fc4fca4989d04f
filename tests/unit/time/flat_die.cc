// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// New nodes beside a flat die. The top of a quarter of a cylinder is a dome that a plane has flattened: its faces are
// one region, and the normals of nodes at the rim of the flat part lean outwards, so that by them new nodes are lifted
// beyond the plane. Proved: the plane keeps them out, to what counts as resting on it; where it is not in the press,
// they go more than 0.01 of the element size beyond. Those it puts there follow it: differences of remeshings with the
// plane elsewhere are what the tape gives, whose reverse is its transpose.

#include <deal.II/base/mpi.h>

#include "../random_numbers.h"
#include <retroforge/billet/billet.h>
#include <retroforge/time/remesher.h>

#include <cstdio>

using namespace retroforge;

namespace
{
  constexpr double height = 28., flat_radius = 12.1, slope = 0.02, size = 3.5;

  TetMesh quarter()
  {
    BilletParameters billet;
    billet.shape           = BilletParameters::Shape::cylinder;
    billet.radius          = 18.;
    billet.height          = height;
    billet.element_size    = 2.5 * size;
    billet.symmetry_planes = {Vec3({-1., 0., 0.}), Vec3({0., -1., 0.})};
    return make_billet(billet, MPI_COMM_WORLD);
  }

  struct Scene
  {
    TetMesh              mesh = quarter();
    std::vector<Die>     dies;
    NodalVectors<double> X;

    Scene()
    {
      RandomNumbers numbers;
      dies.emplace_back("upper", Vec3({0., 0., height}), Vec3({0., 0., -1.}));
      for (const Vec3 &x : mesh.X)
      {
        // The dome falls by 2 slope r at r, beyond the flat part; the metal below it follows by its height.
        const double fall = std::max(0., slope * (x[0] * x[0] + x[1] * x[1] - flat_radius * flat_radius));
        Vec3         y({x[0], x[1], x[2] - x[2] / height * fall});
        // No two edges are equally long, and the plane stays flat.
        for (unsigned int i = 0; i < 3; ++i)
          if (y[i] > 1e-9 && !(i == 2 && y[i] > height - 1e-9))
            y[i] += 0.1 * numbers.scalar();
        X.push_back(y);
      }
    }

    std::shared_ptr<const RemeshRecord> remesh(const double lowered, const bool in_press = true) const
    {
      RemesherParameters parameters;
      parameters.sizes = RemesherParameters::Sizes::uniform;
      const Remesher   remesher(parameters, size, dies, mesh.patches, MPI_COMM_WORLD);
      DieState<double> state;
      state.displacement = Vec3({0., 0., -lowered});
      state.in_press     = in_press;
      Timings timings;
      return remesher.remesh(mesh, X, {state}, {}, 0., timings);
    }
  };

  double highest(const RemeshRecord &record)
  {
    double z = 0.;
    for (const Vec3 &x : record.mesh.X)
      z = std::max(z, x[2]);
    return z;
  }

  const char *yes(const bool condition)
  {
    return condition ? "yes" : "NO";
  }

  NodalVectors<Dual> tangent(const Scene                &scene,
                             const RemeshRecord         &record,
                             const NodalVectors<double> &X_dot,
                             const double                lowering)
  {
    NodalVectors<Dual> X(X_dot.size());
    DieState<Dual>     state;
    for (std::size_t k = 0; k < X.size(); ++k)
      for (unsigned int i = 0; i < 3; ++i)
      {
        X[k][i]                 = scene.X[k][i];
        X[k][i].fastAccessDx(0) = X_dot[k][i];
      }
    state.displacement[2].fastAccessDx(0) = -lowering;
    return record.positions.positions<Dual>({scene.mesh, record.mesh, scene.dies, {state}}, X);
  }

  void compare_with_differences(const Scene &scene, const RemeshRecord &record)
  {
    const NodalVectors<Dual> derivative = tangent(scene, record, NodalVectors<double>(scene.X.size()), 1.);
    bool                     same       = true;
    double                   error = 0., largest = 0.;
    for (const double h : {1e-5, 1e-6})
    {
      const auto plus = scene.remesh(h), minus = scene.remesh(-h);
      same = same && plus->mesh.cells == record.mesh.cells && minus->mesh.cells == record.mesh.cells;
      for (NodeIndex k = 0; same && k < record.mesh.n_nodes(); ++k)
        for (unsigned int i = 0; i < 3; ++i)
        {
          const double difference = (plus->mesh.X[k][i] - minus->mesh.X[k][i]) / (2. * h);
          largest                 = std::max(largest, std::abs(difference));
          error                   = std::max(error, std::abs(difference - derivative[k][i].dx(0)));
        }
    }
    std::printf(
      "the plane elsewhere: the same mesh: %s, some nodes follow: %s, all as the tape says, to 1e-7: %s\n",
      yes(same),
      yes(largest > 0.9),
      yes(error < 1e-7));
  }

  void compare_with_transpose(const Scene &scene, const RemeshRecord &record)
  {
    RandomNumbers              numbers;
    const NodalVectors<double> X_dot  = numbers.vectors(scene.X.size());
    const NodalVectors<Dual>   placed = tangent(scene, record, X_dot, 1.);
    const NodalVectors<double> y      = numbers.vectors(placed.size());

    NodalVectors<double>                X_bar(scene.X.size());
    std::vector<DieState<double>>       bar(1);
    const std::vector<DieState<double>> states(1);
    record.positions.reverse_positions({scene.mesh, record.mesh, scene.dies, states}, scene.X, y, X_bar, bar);
    double forward = 0., length = 0.;
    for (std::size_t k = 0; k < y.size(); ++k)
      for (unsigned int i = 0; i < 3; ++i)
      {
        forward += y[k][i] * placed[k][i].dx(0);
        length += std::abs(y[k][i] * placed[k][i].dx(0));
      }
    const double reverse = dot(X_bar, X_dot) - bar[0].displacement[2];
    std::printf("the reverse is the transpose: %s\n", yes(std::abs(forward - reverse) < 1e-13 * length));
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const Scene                              scene;
  const auto                               record = scene.remesh(0.);
  std::printf("nodes beyond the plane by less than 1e-5 of the size: %s; without it by more than 1e-2: %s\n",
              yes(highest(*record) < height + 1e-5 * size),
              yes(highest(*scene.remesh(0., false)) > height + 1e-2 * size));
  compare_with_differences(scene, *record);
  compare_with_transpose(scene, *record);
}
