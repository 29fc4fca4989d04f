// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Boxes cut by symmetry planes. Proved: the mesh has the volume of the solid and each patch the area of its
// side, to 1e-12; nodes lie on the symmetry planes and their faces point outwards; angles are fit for use.
// By hand: a cube of 50 mm has 125000 mm3 and sides of 2500 mm2; a quarter 31250, with sides of 1250 or 625;
// an eighth 15625 and 625. The plane through the centre with normal (1, 1, 1) halves the cube in a regular
// hexagon with edges 50/sqrt2, of area 3 sqrt3/2 1250 = 3247.595 mm2, through the midpoints of edges: three
// sides lose a triangle 25 x 25 / 2 and keep 7/8, the others keep the triangle.

#include <deal.II/base/mpi.h>

#include "../mesh/mesh_test_tools.h"

using namespace retroforge;

void report(const std::string &title, const TetMesh &mesh, const double exact_volume)
{
  std::cout << title << "\n  volume exact to 1e-12: "
            << yes(std::abs(volume(mesh.cells, mesh.X) / exact_volume - 1) < 1e-12)
            << "\n  on the symmetry planes: " << yes(symmetry_defect(mesh) < 1e-11)
            << "\n  min dihedral angle > 8: " << yes(minimum_dihedral_angle(mesh.cells, mesh.X) > 8)
            << "\n  min quality > 0.1: " << yes(minimum_quality(mesh.cells, mesh.X) > 0.1) << "\n";
  for (unsigned int p = 0; p < mesh.patches.size(); ++p)
  {
    std::cout << "  " << mesh.patches[p].name << ": area " << patch_area(mesh, p);
    if (mesh.patches[p].symmetry)
      std::cout << ", normal " << mesh.patches[p].symmetry->normal;
    std::cout << "\n";
  }
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  report("whole", billet({{"element size", "10"}}), 125000);
  report("moved oblong",
         billet({{"size", "20, 30, 70"}, {"base centre", "5, -3, 11"}, {"element size", "8"}}),
         42000);
  report("quarter", billet({{"element size", "8"}, {"symmetry planes", "-1, 0, 0; 0, -1, 0"}}), 31250);
  report("eighth",
         billet({{"element size", "6"},
                 {"symmetry planes", "-1, 0, 0; 0, -1, 0; 0, 0, 1"},
                 {"symmetry point", "centre"}}),
         15625);
  report("eighth about a given point",
         billet({{"element size", "6"},
                 {"symmetry planes", "2, 0, 0; 0, -3, 0; 0, 0, -1"},
                 {"symmetry point", "0, 0, 25"}}),
         15625);
  report("half by an oblique plane",
         billet({{"element size", "7"}, {"symmetry planes", "1, 1, 1"}, {"symmetry point", "centre"}}),
         62500);
  report("base declared a symmetry plane",
         billet({{"element size", "15"}, {"symmetry planes", "0, 0, -1"}}),
         125000);
}
