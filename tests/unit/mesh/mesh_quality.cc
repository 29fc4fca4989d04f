// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Measures of single tetrahedra, known in closed form. The regular one: volume sqrt2/12 l^3, dihedral angle
// acos(1/3) = 70.528779 degrees, q = sin = 0.942809. The corner of a cube: volume 1/6, angles 90 and
// atan(sqrt2) = 54.735610 degrees, whose sine is 0.816497, and sqrt2 6V/l_rms^3 = sqrt2/1.5^1.5 = 0.769800
// decides. A sliver: two unit half-diagonals of a square, one pair of ends lowered and one lifted by e; its
// angle is derived below. Flat: 0. Inverted: volume and quality negative, angle 0.

#include "mesh_test_tools.h"

using namespace retroforge;

void report(const std::string &title, const TetCorners &x)
{
  std::cout << title << ": volume " << tet_volume(x) << ", angle " << minimum_dihedral_angle(x)
            << ", quality " << tet_quality(x) << "\n";
}

int main()
{
  const Vec3 o({0, 0, 0}), x({1, 0, 0}), y({0, 1, 0}), z({0, 0, 1});
  report("regular", {{o, x + y, y + z, x + z}});
  report("inverted", {{o, x + y, x + z, y + z}});
  report("corner", {{o, x, y, z}});
  report("flat", {{o, x, y, x + y}});
  const double e = 0.01;
  report("sliver", {{-1. * x - e * z, x - e * z, y + e * z, -1. * y + e * z}});
  // By hand: the faces of the sliver have normals (0, +-2e, 1) below and (+-2e, 0, -1) above; the angle
  // between neighbours along the rim has the cosine 1/(1 + 4 e^2).
  std::cout << "its angle by hand: " << std::acos(1 / (1 + 4 * e * e)) * 180 / M_PI << "\n";

  const NodalVectors<double>                  X     = {o, x, y, z, -1. * z};
  const std::vector<std::array<NodeIndex, 4>> cells = {{{0, 1, 2, 3}}, {{0, 2, 1, 4}}};
  std::cout << "two cells: volume " << volume(cells, X) << ", angle " << minimum_dihedral_angle(cells, X)
            << ", quality " << minimum_quality(cells, X) << "\n";
}
