// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves: a damaged Gmsh file, of any version, ASCII or binary, is refused with an Error, or read as a mesh
// that check_mesh() knows for good or refuses. First: the whole files, which Gmsh writes here, give the mesh
// that Gmsh has in memory.
#include "mutate.h"

#include <retroforge/billet/msh_mesh.h>
#include <retroforge/core/error.h>
#include <retroforge/mesh/mesh_checks.h>

#include <filesystem>
#include <gmsh.h>
#include <map>

using namespace retroforge;

const std::string file = "damaged.msh";

struct Whole
{
  std::string name, bytes;
};

using Corners = std::vector<std::array<Vec3, 4>>;

/// The tetrahedra as Gmsh has them in memory.
Corners corners_in_gmsh()
{
  std::vector<std::size_t> tags, elements, nodes;
  std::vector<double>      coordinates, parameters;
  gmsh::model::mesh::getNodes(tags, coordinates, parameters);
  std::map<std::size_t, Vec3> X;
  for (std::size_t i = 0; i < tags.size(); ++i)
    X[tags[i]] = Vec3({coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]});
  gmsh::model::mesh::getElementsByType(4, elements, nodes);
  Corners corners(nodes.size() / 4);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    corners[i / 4][i % 4] = X.at(nodes[i]);
  return corners;
}

/// A small box with a named and an unnamed physical surface.
std::vector<Whole> whole_files(Corners &corners)
{
  std::vector<Whole> files;
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Verbosity", 0);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("Mesh.MeshSizeMin", 0.7);
  gmsh::option::setNumber("Mesh.MeshSizeMax", 0.7);
  gmsh::model::add("box");
  gmsh::model::occ::addBox(0, 0, 0, 1, 1, 1);
  gmsh::model::occ::synchronize();
  gmsh::model::setPhysicalName(2, gmsh::model::addPhysicalGroup(2, {1}), "left side");
  gmsh::model::addPhysicalGroup(2, {3, 5});
  gmsh::model::addPhysicalGroup(2, {2, 4, 6});
  gmsh::model::addPhysicalGroup(3, {1});
  gmsh::model::mesh::generate(3);
  corners = corners_in_gmsh();
  for (const char *version : {"2.2", "4", "4.1"})
    for (const int binary : {0, 1})
    {
      if (std::string(version) == "4" && binary == 1) // which Gmsh no longer writes
        continue;
      gmsh::option::setNumber("Mesh.MshFileVersion", std::atof(version));
      gmsh::option::setNumber("Mesh.Binary", binary);
      gmsh::write("whole.msh");
      files.push_back(
        {std::string(version) + (binary == 0 ? " ASCII" : " binary"), fuzz::bytes_of("whole.msh")});
    }
  gmsh::finalize();
  return files;
}

/// Cells in the order of Gmsh's, with its positions to the digits of the file.
bool same(const TetMesh &mesh, const Corners &corners)
{
  bool same = mesh.n_cells() == corners.size();
  for (CellIndex c = 0; same && c < mesh.n_cells(); ++c)
    for (unsigned int a = 0; a < 4; ++a)
      same = same && (mesh.X[mesh.cells[c][a]] - corners[c][a]).norm() < 1e-13;
  return same;
}

void compare(const std::vector<Whole> &files, const Corners &corners)
{
  for (const Whole &whole : files)
  {
    fuzz::write_bytes(file, whole.bytes);
    const TetMesh mesh = read_msh(file, {"left side"});
    check_mesh(mesh, file);
    std::cout << whole.name << ": the mesh of Gmsh " << (same(mesh, corners) ? "yes" : "NO") << ", patches";
    for (const Patch &patch : mesh.patches)
      std::cout << " `" << patch.name << "'" << (patch.symmetry ? " (symmetry)" : "");
    std::cout << '\n';
  }
}

int main()
{
  Corners    corners;
  const auto files = whole_files(corners);
  if (std::getenv("FUZZ_ONLY") == nullptr)
    compare(files, corners);
  for (const Whole &whole : files)
    fuzz::run("mesh file " + whole.name, file, [&](fuzz::Random &random) {
      std::string bytes = fuzz::mutate(whole.bytes, random);
      if (random.below(10) == 0)
        bytes.replace(0,
                      bytes.find("$EndMeshFormat"),
                      random.one_of(files).bytes.substr(0, whole.bytes.find("$EndMeshFormat")));
      fuzz::write_bytes(file, bytes);
      TetMesh mesh = read_msh(file, {});
      check_mesh(mesh, file);
    });
}
