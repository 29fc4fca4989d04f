// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Meshes from Gmsh files, written here by hand: the unit cube in five tetrahedra, corners at 0 and 1. Proved:
// versions 2 and 4 give the same mesh; physical surfaces become patches with the areas of the sides (1 mm2
// each); planes of symmetry patches are fitted; tetrahedra numbered the other way round are turned; line
// ends, a byte order mark, elements without tags or of second order, several volumes and tetrahedra that are
// there twice leave the mesh as it is, with a remark where something was left out; each kind of bad file is
// refused.

#include <deal.II/base/mpi.h>

#include "../mesh/mesh_test_tools.h"

#include <algorithm>
#include <fstream>
#include <map>
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
    write_v2(out);
  }

  void write_v2(std::ostream &out) const
  {
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
  for (const std::string &remark : mesh.remarks)
    std::cout << "  " << remark << "\n";
}

std::string replaced(std::string text, const std::string &from, const std::string &to)
{
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

// The cube with the middles of all edges, its elements of second order.
void write_second_order(const std::string &name)
{
  Cube                              cube;
  std::map<std::array<int, 2>, int> middle;
  const auto                        node = [&](int a, int b) {
    if (a > b)
      std::swap(a, b);
    const auto [found, is_new] = middle.insert({{{a, b}}, static_cast<int>(cube.nodes.size()) + 1});
    if (is_new)
    {
      const auto x = cube.nodes[a - 1], y = cube.nodes[b - 1];
      cube.nodes.push_back({{(x[0] + y[0]) / 2, (x[1] + y[1]) / 2, (x[2] + y[2]) / 2}});
    }
    return found->second;
  };
  std::ostringstream elements;
  int                number = 0;
  for (const auto &t : cube.triangles)
    elements << ++number << " 9 2 " << t[0] << " " << t[0] << " " << t[1] << " " << t[2] << " " << t[3] << " "
             << node(t[1], t[2]) << " " << node(t[2], t[3]) << " " << node(t[3], t[1]) << "\n";
  for (const auto &t : cube.tets)
    elements << ++number << " 11 2 9 9 " << t[0] << " " << t[1] << " " << t[2] << " " << t[3] << " "
             << node(t[0], t[1]) << " " << node(t[1], t[2]) << " " << node(t[2], t[0]) << " "
             << node(t[3], t[0]) << " " << node(t[3], t[2]) << " " << node(t[3], t[1]) << "\n";
  std::ofstream out(name);
  out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << cube.nodes.size() << "\n";
  for (std::size_t i = 0; i < cube.nodes.size(); ++i)
    out << i + 1 << " " << cube.nodes[i][0] << " " << cube.nodes[i][1] << " " << cube.nodes[i][2] << "\n";
  out << "$EndNodes\n$Elements\n" << number << "\n" << elements.str() << "$EndElements\n";
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

  Cube mixed;
  std::swap(mixed.tets[3][0], mixed.tets[3][1]);
  mixed.write_v2("mixed.msh");
  report("one inverted", read("mixed.msh"));

  std::ostringstream whole;
  Cube().write_v2(whole);
  const std::string text = whole.str();
  for (const auto &[title, bytes] : std::vector<std::pair<std::string, std::string>>{
         {"line ends \\r", replaced(text, "\n", "\r")},
         {"line ends \\r\\n", replaced(text, "\n", "\r\n")},
         {"byte order mark", "\xef\xbb\xbf" + text},
         {"version 2.0", replaced(text, "2.2 0 8", "2 0 8")},
         {"no tags", replaced(text, " 4 2 9 9 ", " 4 0 ")},
         {"two volumes", replaced(text, "9 4 2 9 9 ", "9 4 2 8 8 ")},
         {"a tetrahedron in two groups",
          replaced(replaced(text, "$Elements\n9", "$Elements\n10"),
                   "\n9 4 2 9 9 ",
                   "\n10 4 2 8 9 2 4 5 7\n9 4 2 9 9 ")},
         {"data of elements", text + "$ElementData\n1\n\"E\"\n1\n0\n3\n0\n1\n1\n9 1.5\n$EndElementData\n"}})
  {
    std::ofstream("form.msh", std::ios::binary) << bytes;
    report(title, read("form.msh"));
  }
  write_second_order("second.msh");
  report("second order", read("second.msh"));

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
  refuse("folded", "", [](Cube &cube) { cube.nodes[0] = {{1, 1, 0.5}}; });
  std::ofstream("part.step") << "ISO-10303-21;\nHEADER;\n";
  print_error("a STEP file", []() { read("part.step"); });
  std::ofstream("part.stl") << "solid part\nfacet normal 0 0 0\n";
  print_error("an STL file", []() { read("part.stl"); });
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
