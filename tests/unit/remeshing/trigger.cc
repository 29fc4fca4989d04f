// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// When to remesh. A box of perfect cubes has angles of 45 degrees and more; pressing it to 20 % makes the
// least 11.3 = atan(0.2), below the trigger. A single tetrahedron of 5 degrees between two boundary faces
// cannot be helped, and is not counted; nor is a cell that was frozen, until it has lost half its angle.
// Inverted cells always count.

#include "remeshing_test_tools.h"

using namespace retroforge;

NodalVectors<double> pressed(NodalVectors<double> X, const double factor)
{
  for (Vec3 &x : X)
    x[2] *= factor;
  return X;
}

std::string asks(const bool needs)
{
  return needs ? "remesh" : "go on";
}

int main()
{
  const RemeshingParameters parameters;
  TetMesh                   box = kuhn_box(2, 0.);
  std::cout << "cubes: angle " << minimum_dihedral_angle(box.cells, box.X) << ", "
            << asks(needs_remeshing(box, box.X, parameters, {})) << "\n";
  for (const double factor : {0.3, 0.2})
  {
    const auto X = pressed(box.X, factor);
    std::cout << "pressed to " << factor << ": free angle " << minimum_free_angle(box, X) << ", "
              << asks(needs_remeshing(box, X, parameters, {})) << "\n";
  }

  TetMesh      wedge;
  const double sine = std::sin(5 * M_PI / 180), cosine = std::cos(5 * M_PI / 180);
  wedge.X     = {Vec3({0, 0, 0}), Vec3({1, 0, 0}), Vec3({0.5, 1, 0}), Vec3({0.5, cosine, sine})};
  wedge.cells = {{{0, 1, 2, 3}}};
  add_one_patch(wedge);
  std::cout << "wedge: angle " << minimum_dihedral_angle(wedge.cells, wedge.X) << ", "
            << asks(needs_remeshing(wedge, wedge.X, parameters, {})) << "\n";
  wedge.X[3][2] = -0.1;
  std::cout << "wedge, inverted: " << asks(needs_remeshing(wedge, wedge.X, parameters, {})) << "\n";

  TetMesh left_bad  = box;
  left_bad.X        = pressed(box.X, 0.2);
  const auto frozen = frozen_cells(left_bad, parameters);
  std::cout << "frozen cells: " << std::count(frozen.begin(), frozen.end(), true) << " of " << frozen.size()
            << "; in the cubes: ";
  const auto none = frozen_cells(box, parameters);
  std::cout << std::count(none.begin(), none.end(), true) << "\n";
  for (const double factor : {0.19, 0.09})
    std::cout << "left at 0.2, now at " << factor << ": "
              << asks(needs_remeshing(left_bad, pressed(box.X, factor), parameters, frozen)) << "\n";
}
