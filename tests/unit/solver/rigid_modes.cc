// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Which rigid motions of a box of 20 x 20 x 20 mm are free, in words. Between planes without friction it
// slides along them and turns about their normal; one symmetry plane leaves a slide, two leave none, a die
// with friction none; where nothing is near enough, all six are free. Turned by 30 degrees, it slides along
// its symmetry plane.

#include <deal.II/base/mpi.h>

#include <retroforge/billet/billet.h>
#include <retroforge/solver/rigid_modes.h>

#include <iostream>

using namespace retroforge;

void print(const std::string           &what,
           const std::vector<Vec3>     &symmetry_planes,
           const double                 friction,
           const double                 angle  = 0.,
           const std::optional<double> &within = {})
{
  BilletParameters billet;
  billet.size            = Vec3({20., 20., 20.});
  billet.element_size    = 10.;
  billet.symmetry_planes = symmetry_planes;
  billet.rotations.angle = angle;
  const Scene     scene(make_billet(billet, MPI_COMM_WORLD),
                    {},
                    {Die("lower", Vec3({0., 0., -1.}), Vec3({0., 0., 1.})),
                         Die("upper", Vec3({0., 0., 21.}), Vec3({0., 0., -1.}))},
                    MPI_COMM_WORLD);
  Physics<double> physics;
  physics.dies.resize(2);
  physics.dies[1].friction = friction;
  const auto motions       = free_rigid_motions(scene, physics, scene.mesh.X, within);
  std::cout << what << ": " << motions.size() << " free";
  for (const std::string &motion : motions)
    std::cout << "; " << motion;
  std::cout << '\n';
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  const Vec3 x({-1., 0., 0.}), y({0., -1., 0.});
  print("no friction", {}, 0.);
  print("one symmetry plane", {x}, 0.);
  print("turned with it", {x}, 0., 30.);
  print("two", {x, y}, 0.);
  print("friction", {}, 0.3);
  print("dies too far", {}, 0.3, 0., 0.5);
  print("dies near", {}, 0.3, 0., 1.5);
}
