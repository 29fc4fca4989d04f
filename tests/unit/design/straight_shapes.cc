// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Box and cylinder, turned and shifted. Proved: stretch and radius multiply the volume of the mesh by the
// square of their factor, height by its factor, the base stays; derivatives agree with differences (151);
// the volume can be held by any parameter, and then the radius is r sqrt(h_0/h); a parameter that would move
// nodes off a symmetry plane is not offered.

#include <deal.II/base/mpi.h>

#include "design_test_tools.h"

using namespace retroforge;

const Entries moved = {{"base centre", "1, 2, 3"},
                       {"rotation axis", "1, -1, 0.3"},
                       {"rotation angle", "50"},
                       {"translation", "4, 5, 6"},
                       {"element size", "12"},
                       {"symmetry planes", "-1, 0, 0; 0, -1, 0"}};

double base_motion(const MappedBillet &billet, const NodalVectors<double> &X, const Vec3 &axis)
{
  double most = 0.;
  for (const BoundaryFace &face : billet.mesh.faces)
    if (billet.mesh.patches[face.patch].name == "bottom")
      for (const NodeIndex node : face.nodes)
        most = std::max(most, std::abs((X[node] - billet.mesh.X[node]) * axis));
  return most;
}

// The billet's z axis, from its bottom's area vector.
Vec3 axis_of(const TetMesh &mesh)
{
  Vec3 normal;
  for (const BoundaryFace &face : mesh.faces)
    if (mesh.patches[face.patch].name == "bottom")
      normal -= face_normal(mesh, face);
  return normal / normal.norm();
}

void report(const std::string &shape)
{
  Entries entries = moved;
  entries.push_back({"shape", shape});
  const MappedBillet billet(entries);
  std::cout << shape << "\n  identity at the nominal values: " << yes(is_identity(billet)) << "\n";
  for (unsigned int j = 0; j < billet.nominal.size(); ++j)
  {
    const auto  X    = billet.map.positions(billet.changed(j, 5.));
    const auto &name = billet.map.parameters()[j].name;
    std::cout << "  " << name << " + 5 mm: volume times "
              << volume(billet.mesh.cells, X) / volume(billet.mesh.cells, billet.mesh.X)
              << ", base stays level: " << yes(base_motion(billet, X, axis_of(billet.mesh)) < 1e-12)
              << ", symmetry: " << yes(symmetry_defect_at(billet.mesh, X) < 1e-11)
              << ", differences: " << yes(derivative_error(billet.map, billet.nominal, j) < 1e-8) << "\n";
  }
}

void report_held(const std::string &shape, const std::string &by)
{
  Entries entries = moved;
  entries.insert(entries.end(), {{"shape", shape}, {"volume held by", by}});
  const MappedBillet billet(entries);
  const auto         mu = billet.changed(0, 5.);
  std::cout << shape << ", volume held by " << by << "\n  " << billet.map.parameters()[0].name
            << " + 5 mm: " << by << " is " << billet.map.held_value(mu)
            << ", volume kept: " << yes(relative_change_of_volume(billet, billet.map.positions(mu)) < 1e-12)
            << ", differences: " << yes(derivative_error(billet.map, mu, 0) < 1e-8) << "\n";
}

void offered(Entries entries)
{
  std::cout << "offered:";
  const MappedBillet billet(entries);
  for (const ShapeParameter &shape : billet.map.parameters())
    std::cout << ' ' << shape.name << ';';
  std::cout << "\n";
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  report("box");
  report("cylinder");
  std::cout << "sqrt(50/55) 25 = " << std::sqrt(50. / 55.) * 25. << "\n";
  report_held("cylinder", "radius");
  report_held("cylinder", "height");
  report_held("box", "stretch");
  report_held("box", "height");
  offered({{"symmetry planes", "0, 0, 1"}, {"symmetry point", "centre"}, {"element size", "20"}});
  offered({{"symmetry planes", "1, 0, 0"}, {"symmetry point", "5, 0, 0"}, {"element size", "20"}});
}
