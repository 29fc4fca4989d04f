// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Bodies of revolution whose contour is a B-spline: a barrel, a dome closed at the axis, a ring. Proved: with
// control points on a straight line the spline is that line, so the body is a cylinder or a cone; the values
// of the basis sum to one and the derivative is that of differences; the closest point of a quarter circle is
// along the radius; nodes of the outer side lie on the contour; the volume of the mesh falls short of that of
// the body by the chords only; no cell is flat, in particular none whose four nodes are on the round side.

#include <deal.II/base/mpi.h>

#include "../mesh/mesh_test_tools.h"

#include <numeric>

using namespace retroforge;

void test_curve()
{
  const SplineCurve spline({Vec2({1, 0}), Vec2({3, 1}), Vec2({2, 2}), Vec2({4, 5}), Vec2({1, 6})}, 3);
  const SplineCurve circle({Vec2({1, 0}), Vec2({1, 1}), Vec2({0, 1})}, 2, {1., std::sqrt(0.5), 1.});
  double            sum = 0., slope = 0., radius = 0., angle = 0.;
  for (const double t : {0., 0.1, 0.37, 0.5, 0.8, 1.})
  {
    const auto R = spline.basis(t);
    sum          = std::max(sum, std::abs(std::accumulate(R.begin(), R.end(), -1.)));
    if (t > 0. && t < 1. && t != 0.5)
      slope = std::max(
        slope, ((spline.value(t + 1e-5) - spline.value(t - 1e-5)) / 2e-5 - spline.derivative(t)).norm());
    radius       = std::max(radius, std::abs(circle.value(t).norm() - 1.));
    const Vec2 c = circle.value(t);
    for (const double factor : {0.5, 0.9, 1.3})
      angle = std::max(angle, (circle.value(circle.closest(factor * c)) - c).norm());
  }
  std::cout << "basis sums to one: " << yes(sum < 1e-15) << "\nderivative: " << yes(slope < 1e-8)
            << "\nrational quadratic is a circle: " << yes(radius < 1e-15)
            << "\nclosest point is along the radius: " << yes(angle < 1e-12) << "\n";
}

void report(const std::string                               &name,
            std::vector<std::pair<std::string, std::string>> entries,
            const double                                     exact = 0.)
{
  entries.push_back({"shape", "profile"});
  const BilletParameters parameters = billet_parameters(entries);
  const SplineProfile   &profile    = parameters.profile;
  const TetMesh          mesh       = billet(entries);
  double                 worst      = 0.;
  for (const auto &face : mesh.faces)
    if (mesh.patches[face.patch].name == "side outer")
      for (const NodeIndex node : face.nodes)
      {
        const Vec2 x({std::hypot(mesh.X[node][0], mesh.X[node][1]), mesh.X[node][2]});
        worst = std::max(worst, (profile.contour().value(profile.contour().closest(x)) - x).norm());
      }
  const double angle = parameters.sector_angle == 0. ? 360. : parameters.sector_angle;
  const double whole = volume_of_revolution(profile.section());
  const double loss  = 1. - volume(mesh.cells, mesh.X) / (whole * angle / 360.);
  std::cout << name;
  if (exact > 0.)
    std::cout << "\n  volume of the section: " << yes(std::abs(whole / exact - 1.) < 1e-13);
  std::cout << "\n  nodes on the contour: " << yes(worst < 1e-11)
            << "\n  on the symmetry planes: " << yes(symmetry_defect(mesh) < 1e-11)
            << "\n  volume short by the chords only: " << yes(loss > 0. && loss < 0.03)
            << "\n  min dihedral angle > 7: " << yes(minimum_dihedral_angle(mesh.cells, mesh.X) > 7.)
            << "\n ";
  for (const auto &patch : mesh.patches)
    std::cout << ' ' << patch.name << ';';
  std::cout << "\n";
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  test_curve();
  report("cylinder",
         {{"control points", "20, 0; 20, 10; 20, 20; 20, 30"}, {"sector angle", "60"}, {"element size", "5"}},
         M_PI * 400. * 30.);
  report("cone",
         {{"control points", "20, 0; 16, 10; 12, 20; 8, 30"}, {"sector angle", "90"}, {"element size", "5"}},
         M_PI / 3. * 30. * (400. + 160. + 64.));
  for (const std::string h : {"5", "5.5", "6"})
    report("barrel, element size " + h,
           {{"control points", "20, 0; 26, 15; 27, 20; 26, 30; 20, 45"}, {"element size", h}});
  report("dome",
         {{"control points", "20, 0; 22, 8; 20, 25; 10, 30; 0, 30"},
          {"sector angle", "90"},
          {"element size", "4"}});
  report("ring",
         {{"control points", "20, 0; 26, 10; 18, 20; 22, 40"},
          {"inner radius", "10"},
          {"sector angle", "36"},
          {"element size", "4"}});
}
