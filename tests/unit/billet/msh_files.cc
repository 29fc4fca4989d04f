// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Meshes from Gmsh files, written here by hand: the unit cube in five tetrahedra, corners at 0 and 1. Proved:
// versions 2 and 4 give the same mesh; physical surfaces become patches with the areas of the sides (1 mm2
// each); planes of symmetry patches are fitted; a mesh that is inverted throughout is turned; each kind of
// bad file is refused.

#include <deal.II/base/mpi.h>

#include "../mesh/mesh_test_tools.h"

#include <algorithm>
#include <fstream>
#include <sstream>

using namespace retroforge;

struct Cube
{
  std::vector<std::array<double, 3>> nodes =
    {{{0, 0, 0}}, {{1, 0, 0}}, {{1, 1, 0}}, {{0, 1, 0}}, {{0, 0, 1}}, {{1, 0, 1}}, {{1, 1, 1}}, {{0, 1, 1}}};
  std::vector<std::array<int, 4>> tets = {{{1, 2, 4, 5}},
                                          {{3, 4, 2, 7}},
                                          {{6, 5, 7, 2}},
                                          {{8, 7, 5, 4}},
                                          {{2, 4, 5, 7}}};
  // physical number and nodes; x = 0 is surface 1 `left', z = 0 is surface 2 without a name
  std::vector<std::array<int, 4>> triangles = {{{1, 1, 4, 5}},
                                               {{1, 8, 4, 5}},
                                               {{2, 1, 2, 4}},
                                               {{2, 3, 4, 2}}};

  void write_v2(const std::string &name) const
  {
    std::ofstream out(name);
    out
      << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"left\"\n$EndPhysicalNames\n$Nodes\n"
      << nodes.size() << "\n";
    for (std::size_t i = 0; i < nodes.size(); ++i)
      out << i + 1 << " " << nodes[i][0] << " " << nodes[i][1] << " " << nodes[i][2] << "\n";
    out << "$EndNodes\n$Elements\n" << tets.size() + triangles.size() << "\n";
    int number = 0;
    for (const auto &t : triangles)
      out << ++number << " 2 2 " << t[0] << " " << t[0] << " " << t[1] << " " << t[2] << " " << t[3] << "\n";
    for (const auto &t : tets)
      out << ++number << " 4 2 9 9 " << t[0] << " " << t[1] << " " << t[2] << " " << t[3] << "\n";
    out << "$EndElements\n";
  }

  void write_v4(const std::string &name) const
  {
    std::ofstream out(name);
    out << "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"left\"\n$EndPhysicalNames\n"
        << "$Entities\n0 0 2 1\n1 0 0 0 0 1 1 1 1 0\n2 0 0 0 1 1 0 1 2 0\n9 0 0 0 1 1 1 0 0\n$EndEntities\n"
        << "$Nodes\n1 8 1 8\n3 9 0 8\n1\n2\n3\n4\n5\n6\n7\n8\n";
    for (const auto &x : nodes)
      out << x[0] << " " << x[1] << " " << x[2] << "\n";
    out << "$EndNodes\n$Elements\n3 9 1 9\n2 1 2 2\n";
    int number = 0;
    for (std::size_t i = 0; i < triangles.size(); ++i)
    {
      if (i == 2)
        out << "2 2 2 2\n";
      out << ++number << " " << triangles[i][1] << " " << triangles[i][2] << " " << triangles[i][3] << "\n";
    }
    out << "3 9 4 5\n";
    for (const auto &t : tets)
      out << ++number << " " << t[0] << " " << t[1] << " " << t[2] << " " << t[3] << "\n";
    out << "$EndElements\n";
  }
};

TetMesh read(const std::string &name, const std::string &symmetry_patches = "")
{
  return billet({{"shape", "file"}, {"file name", name}, {"symmetry patches", symmetry_patches}});
}

void report(const std::string &title, const TetMesh &mesh)
{
  std::cout << title << ": " << mesh.n_nodes() << " nodes, " << mesh.n_cells() << " cells, volume "
            << volume(mesh.cells, mesh.X) << "\n";
  for (unsigned int p = 0; p < mesh.patches.size(); ++p)
  {
    std::cout << "  " << mesh.patches[p].name << ": area " << patch_area(mesh, p);
    if (mesh.patches[p].symmetry)
      std::cout << ", normal " << mesh.patches[p].symmetry->normal;
    std::cout << "\n";
  }
}

// Writes the cube after it was spoilt, reads it, and prints what was thrown.
template <typename Spoil>
void refuse(const std::string &title, const std::string &symmetry_patches, const Spoil &spoil)
{
  Cube cube;
  spoil(cube);
  cube.write_v2("bad.msh");
  print_error(title, [&]() { read("bad.msh", symmetry_patches); });
}

void sound_files()
{
  Cube cube;
  cube.write_v2("cube2.msh");
  cube.write_v4("cube4.msh");
  report("version 2", read("cube2.msh"));
  report("version 4", read("cube4.msh"));
  report("symmetry by name and number", read("cube4.msh", "left, 2"));

  for (auto &tet : cube.tets)
    std::swap(tet[0], tet[1]);
  cube.write_v2("inverted.msh");
  report("all inverted", read("inverted.msh"));

  Cube extra;
  extra.nodes.push_back({{5, 5, 5}});
  extra.triangles.clear();
  extra.write_v2("extra.msh");
  report("a node too many, no surfaces", read("extra.msh"));

  Cube rounded;
  rounded.nodes[3][0] = 1e-8;
  rounded.write_v2("rounded.msh");
  std::cout << "rounded coordinates put on the plane: "
            << yes(symmetry_defect(read("rounded.msh", "left")) < 1e-14) << "\n";
}

void bad_files()
{
  print_error("missing file", []() { read("not_there.msh"); });
  std::ofstream("script.msh") << "Printf(\"no mesh\");\n";
  print_error("not a mesh", []() { read("script.msh"); });
  std::ofstream("broken.msh") << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n1 0 0\n";
  print_error("broken off", []() { read("broken.msh"); });
  refuse("no tetrahedra", "", [](Cube &cube) { cube.tets.clear(); });
  refuse("some inverted", "", [](Cube &cube) { std::swap(cube.tets[3][0], cube.tets[3][1]); });
  refuse("flat", "", [](Cube &cube) { cube.nodes[0] = {{0.5, 0.5, 0}}; });
  refuse("joined at an edge", "", [](Cube &cube) {
    cube.triangles.clear();
    cube.tets.resize(2);
  });
  refuse("overlap", "", [](Cube &cube) {
    cube.nodes.push_back({{0.1, 0.1, -0.1}});
    cube.tets.push_back({{9, 2, 4, 5}});
  });
  refuse("wrong symmetry patch", "left, right", [](Cube &) {});
  refuse("no physical surfaces", "left", [](Cube &cube) { cube.triangles.clear(); });
  refuse("symmetry patch not planar", "left", [](Cube &cube) { cube.nodes[3][0] = -0.01; });
  refuse("symmetry patch with a corner", "left", [](Cube &cube) { cube.triangles[2][0] = 1; });
  refuse("symmetry patch inside", "left", [](Cube &cube) { cube.triangles = {{{1, 2, 4, 5}}}; });
  refuse("triangle on two surfaces", "", [](Cube &cube) { cube.triangles.push_back({{2, 1, 4, 5}}); });
  refuse("triangle away from the cells", "", [](Cube &cube) {
    cube.nodes.push_back({{5, 5, 5}});
    cube.triangles.push_back({{2, 1, 2, 9}});
  });
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  sound_files();
  bad_files();
}
