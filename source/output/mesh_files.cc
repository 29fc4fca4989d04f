// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/geometry/stl_file.h>
#include <retroforge/output/mesh_files.h>
#include <retroforge/output/safe_file.h>

#include <iomanip>
#include <sstream>

namespace retroforge
{
  namespace
  {
    struct NumberedNode
    {
      NodeIndex   node;
      std::size_t number;
    };

    /// In the order of the file that the mesh was read from, with the numbers there; else counted from 1.
    std::vector<NumberedNode> numbered_nodes(const TetMesh &mesh)
    {
      std::vector<NumberedNode> nodes;
      const FileNodes          &file = mesh.of_file;
      for (std::size_t i = 0; i < file.tags.size(); ++i)
        if (file.nodes[i] != invalid_index)
          nodes.push_back({file.nodes[i], file.tags[i]});
      for (NodeIndex k = 0; file.tags.empty() && k < mesh.n_nodes(); ++k)
        nodes.push_back({k, std::size_t(k) + 1});
      return nodes;
    }
  } // namespace

  void write_msh(const std::string &file, const TetMesh &mesh, const NodalVectors<double> &X)
  {
    constexpr int      triangle = 2, tetrahedron = 4; // Gmsh's numbers
    std::ostringstream out;
    out << std::setprecision(17) << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n"
        << mesh.patches.size() + 1 << '\n';
    for (std::size_t p = 0; p < mesh.patches.size(); ++p)
      out << "2 " << p + 1 << " \"" << mesh.patches[p].name << "\"\n";
    const std::size_t volume = mesh.patches.size() + 1;
    out << "3 " << volume << " \"billet\"\n$EndPhysicalNames\n$Nodes\n" << X.size() << '\n';
    std::vector<std::size_t> number(X.size());
    for (const NumberedNode &node : numbered_nodes(mesh))
    {
      const Vec3 &x     = X[node.node];
      number[node.node] = node.number;
      out << node.number << ' ' << x[0] << ' ' << x[1] << ' ' << x[2] << '\n';
    }
    out << "$EndNodes\n$Elements\n" << mesh.faces.size() + mesh.cells.size() << '\n';
    std::size_t n   = 0;
    const auto  add = [&](const int type, const std::size_t physical, const auto &nodes) {
      out << ++n << ' ' << type << " 2 " << physical << ' ' << physical;
      for (const NodeIndex k : nodes)
        out << ' ' << number[k];
      out << '\n';
    };
    for (const BoundaryFace &face : mesh.faces)
      add(triangle, face.patch + 1, face.nodes);
    for (const auto &cell : mesh.cells)
      add(tetrahedron, volume, cell);
    out << "$EndElements\n";
    write_file(file, out.str());
  }

  void write_boundary_stl(const std::string &file, const TetMesh &mesh, const NodalVectors<double> &X)
  {
    std::vector<Triangle> triangles;
    for (const BoundaryFace &face : mesh.faces)
      triangles.push_back({{face.nodes[0], face.nodes[1], face.nodes[2]}});
    write_stl(file, X, triangles, StlFormat::binary);
  }
} // namespace retroforge
