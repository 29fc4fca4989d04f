// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Cylinders (radius 25, height 50) and their sectors. Proved: nodes of the side lie on the radius; the top
// has the area of the polygon of its rim, 1/2 r^2 sum sin(angle between neighbours); sectors have rectangles
// r h = 1250 mm2 as symmetry planes, with the right normals; the volume falls short of  angle/2 r^2 h  by the
// chords only: a chord s misses the fraction (s/r)^2/6 of its slice, so with edges of h the loss is between
// zero and 1.5 h^2/(6 r^2).

#include <deal.II/base/mpi.h>

#include "../mesh/mesh_test_tools.h"

#include <map>
#include <set>

using namespace retroforge;

constexpr double r = 25, height = 50, h = 6;

unsigned int find_patch(const TetMesh &mesh, const std::string &name)
{
  for (unsigned int p = 0; p < mesh.patches.size(); ++p)
    if (mesh.patches[p].name == name)
      return p;
  return invalid_index;
}

// Edges with a face of the top on one side and of the round side on the other make the rim.
double rim_polygon_area(const TetMesh &mesh)
{
  std::map<std::pair<NodeIndex, NodeIndex>, std::set<unsigned int>> patches_at;
  for (const auto &face : mesh.faces)
    for (unsigned int i = 0; i < 3; ++i)
      patches_at[std::minmax({face.nodes[i], face.nodes[(i + 1) % 3]})].insert(face.patch);
  double area = 0;
  for (const auto &[edge, patches] : patches_at)
    if (patches == std::set<unsigned int>{find_patch(mesh, "top"), find_patch(mesh, "side")})
      area += std::abs(cross_product_3d(mesh.X[edge.first], mesh.X[edge.second])[2]) / 2;
  return area;
}

double radius_defect(const TetMesh &mesh)
{
  double defect = 0;
  for (const auto &face : mesh.faces)
    if (face.patch == find_patch(mesh, "side"))
      for (const NodeIndex node : face.nodes)
        defect = std::max(defect, std::abs(std::hypot(mesh.X[node][0], mesh.X[node][1]) - r));
  return defect;
}

void report(const double degrees, const std::string &symmetry_planes = "", const double share = 1)
{
  const TetMesh mesh = billet({{"shape", "cylinder"},
                               {"element size", std::to_string(h)},
                               {"sector angle", std::to_string(degrees)},
                               {"symmetry point", "centre"},
                               {"symmetry planes", symmetry_planes}});
  const double  loss = 1 - volume(mesh.cells, mesh.X) / (share * degrees / 360 * M_PI * r * r * height);
  std::cout << "sector of " << degrees << " degrees" << (share < 1 ? ", lower half" : "")
            << "\n  nodes of the side on the radius: " << yes(radius_defect(mesh) < 1e-13)
            << "\n  on the symmetry planes: " << yes(symmetry_defect(mesh) < 1e-11)
            << "\n  volume short by the chords only: " << yes(loss > 0 && loss < 1.5 * h * h / (6 * r * r))
            << "\n  min dihedral angle > min(8, half the angle): "
            << yes(minimum_dihedral_angle(mesh.cells, mesh.X) > std::min(8., degrees / 2)) << "\n";
  if (share == 1)
    std::cout << "  top is the polygon of its rim: "
              << yes(std::abs(patch_area(mesh, find_patch(mesh, "top")) / rim_polygon_area(mesh) - 1) < 1e-12)
              << "\n";
  for (unsigned int p = 0; p < mesh.patches.size(); ++p)
  {
    std::cout << "  " << mesh.patches[p].name;
    if (const auto &plane = mesh.patches[p].symmetry)
    {
      std::cout << ": normal " << plane->normal;
      if (plane->normal[2] == 0)
        std::cout << ", area " << patch_area(mesh, p);
    }
    std::cout << "\n";
  }
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  report(360);
  report(18);
  report(60);
  report(90);
  report(137.3);
  report(180);
  report(30, "0, 0, 1", 0.5);
}
