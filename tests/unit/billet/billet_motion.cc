// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Rotation and translation of a finished mesh. Proved: connectivity and patches are those of the mesh at
// rest; distances to the origin before the translation are kept; a quarter turn about z takes (x, y, z) to
// (-y, x, z); the symmetry planes move along (nodes on them, faces along the normal), volume and quality
// stay.

#include <deal.II/base/mpi.h>

#include "../mesh/mesh_test_tools.h"

using namespace retroforge;

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize               mpi(argc, argv, 1);
  const std::vector<std::pair<std::string, std::string>> base = {{"element size", "10"},
                                                                 {"symmetry planes", "-1, 0, 0; 0, -1, 0"}};
  const TetMesh                                          rest = billet(base);

  auto quarter_turn = base;
  quarter_turn.insert(quarter_turn.end(), {{"rotation angle", "90"}, {"translation", "1, 2, 3"}});
  const TetMesh turned = billet(quarter_turn);
  double        defect = 0;
  for (NodeIndex node = 0; node < rest.n_nodes(); ++node)
    defect = std::max(
      defect,
      (turned.X[node] - Vec3({1 - rest.X[node][1], 2 + rest.X[node][0], 3 + rest.X[node][2]})).norm());
  std::cout << "quarter turn and shift: " << yes(defect < 1e-13) << "\n"
            << "normal of symmetry 1 is now -y: "
            << yes((turned.patches[4].symmetry->normal - Vec3({0, -1, 0})).norm() < 1e-15) << "\n";

  auto odd_turn = base;
  odd_turn.insert(odd_turn.end(), {{"rotation axis", "1, -2, 0.5"}, {"rotation angle", "-77.7"}});
  const TetMesh odd     = billet(odd_turn);
  double        stretch = 0;
  for (NodeIndex node = 0; node < rest.n_nodes(); ++node)
    stretch = std::max(stretch, std::abs(odd.X[node].norm() - rest.X[node].norm()));
  std::cout << "odd turn keeps distances: " << yes(stretch < 1e-13) << "\n"
            << "nodes have moved: " << yes((odd.X[0] - rest.X[0]).norm() > 1) << "\n"
            << "same cells: " << yes(odd.cells == rest.cells) << "\n"
            << "on the symmetry planes: " << yes(symmetry_defect(odd) < 1e-11) << "\n"
            << "same volume: "
            << yes(std::abs(volume(odd.cells, odd.X) / volume(rest.cells, rest.X) - 1) < 1e-13) << "\n"
            << "same quality: "
            << yes(std::abs(minimum_quality(odd.cells, odd.X) - minimum_quality(rest.cells, rest.X)) < 1e-12)
            << "\n";
}
