// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// What is drawn of dies.
// - By hand: of a plane z = 10 that has come down by 4, around points that span 20 x 5, the rectangle at
//   z = 6 from -2 to 22 and -2 to 7, its normals down, where the workpiece is.
// - A tilted plane's is in the plane and around the points' feet.
// - A surface is the same, moved.

#include <retroforge/output/die_pictures.h>

#include <iostream>

using namespace retroforge;

void print(const TriangleSurface &surface)
{
  for (const Vec3 &x : surface.vertices())
    std::cout << "  " << x << std::endl;
  for (const Triangle &t : surface.triangles())
  {
    const auto &x = surface.vertices();
    std::cout << "  normal " << unit(facet_vector(x[t[0]], x[t[1]], x[t[2]])) << std::endl;
  }
}

int main()
{
  const NodalVectors<double> points = {Vec3({0, 0, 0}), Vec3({20, 0, 3}), Vec3({20, 5, 1}), Vec3({0, 5, 2})};
  const Die                  upper("upper", Vec3({3, 3, 10}), Vec3({0, 0, -1}));
  std::cout << "plane" << std::endl;
  print(die_picture(upper, Vec3({0, 0, -4}), points));

  const Vec3 facing = unit(Vec3({0.3, -0.2, 1.}));
  const Die  tilted("tilted", Vec3({1, 2, -3}), facing);
  const auto picture = die_picture(tilted, Vec3(), points);
  double     off     = 0.;
  for (const Vec3 &x : picture.vertices())
    off = std::max(off, std::abs((x - Vec3({1, 2, -3})) * facing));
  const auto &x      = picture.vertices();
  bool        around = true;
  for (const Vec3 &point : points)
    for (unsigned int i = 0; i < 4; ++i)
      around = around && cross(Vec3(x[i] - x[(i + 1) % 4]), Vec3(point - x[i])) * facing < 0.;
  std::cout << "tilted plane\n  in it: " << (off < 1e-12) << ", around the points: " << around
            << ", towards the workpiece: " << (facet_vector(x[0], x[1], x[2]) * facing > 0.) << std::endl;

  const Die curved("curved", TriangleSurface("curved", {points[0], points[1], points[2]}, {{{0, 1, 2}}}), 1.);
  std::cout << "surface" << std::endl;
  print(die_picture(curved, Vec3({0, 0, 100}), points));
}
