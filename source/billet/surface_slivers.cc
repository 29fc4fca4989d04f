// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/billet/surface_slivers.h>
#include <retroforge/mesh/cell_faces.h>
#include <retroforge/mesh/mesh_quality.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

namespace retroforge
{
  namespace
  {
    using Cell = std::array<NodeIndex, 4>;

    /// The boundary of cells, and the patch of each of its faces.
    struct Boundary
    {
      std::map<CellIndex, std::vector<FaceKey>> faces; ///< of the cells that have some
      std::set<EdgeKey>                         edges;
      std::map<FaceKey, unsigned int>           patch;

      explicit Boundary(const TetMesh &mesh)
      {
        for (const CellFace &face : boundary_cell_faces(mesh.cells))
        {
          faces[face.cell].push_back(face.key);
          for (unsigned int i = 0; i < 3; ++i)
            edges.insert(edge_key(face.nodes[i], face.nodes[(i + 1) % 3]));
        }
        for (const BoundaryFace &face : mesh.faces)
          patch[face_key(face.nodes)] = face.patch;
      }
    };

    /// Returns the two nodes that faces with a common edge do not share.
    EdgeKey other_diagonal(const FaceKey &a, const FaceKey &b)
    {
      std::vector<NodeIndex> nodes;
      std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(nodes));
      return edge_key(nodes.at(0), nodes.at(1));
    }

    bool may_go(const TetMesh &mesh, const Boundary &boundary, const std::vector<FaceKey> &faces)
    {
      if (faces.size() != 2)
        return false;
      const unsigned int patch = boundary.patch.at(faces[0]);
      return patch == boundary.patch.at(faces[1]) && !mesh.patches[patch].symmetry &&
             boundary.edges.count(other_diagonal(faces[0], faces[1])) == 0;
    }

    /// Cells that may go together: no two of them share a node.
    std::vector<CellIndex> slivers(const TetMesh &mesh, const Boundary &boundary, const double limit)
    {
      std::vector<CellIndex> found;
      std::set<NodeIndex>    touched;
      for (const auto &[c, faces] : boundary.faces)
      {
        const Cell &cell = mesh.cells[c];
        if (!may_go(mesh, boundary, faces) || minimum_dihedral_angle(corners(cell, mesh.X)) >= limit ||
            std::any_of(cell.begin(), cell.end(), [&](const NodeIndex k) { return touched.count(k) > 0; }))
          continue;
        touched.insert(cell.begin(), cell.end());
        found.push_back(c);
      }
      return found;
    }

    /// Takes cells away; each leaves the two faces it had inside to the boundary, on the patch of the others.
    void take_away(TetMesh &mesh, const std::vector<CellIndex> &gone, const Boundary &boundary)
    {
      std::set<FaceKey> old_faces;
      for (const CellIndex c : gone)
      {
        const std::vector<FaceKey> &faces = boundary.faces.at(c);
        old_faces.insert(faces.begin(), faces.end());
        for (const auto &corner : tet_face_corners)
        {
          // Turned: what was outside the cell behind it is inside now.
          const Cell                    &cell = mesh.cells[c];
          const std::array<NodeIndex, 3> face = {{cell[corner[0]], cell[corner[2]], cell[corner[1]]}};
          if (std::count(faces.begin(), faces.end(), face_key(face)) == 0)
            mesh.faces.push_back({face, boundary.patch.at(faces[0])});
        }
      }
      mesh.faces.erase(
        std::remove_if(mesh.faces.begin(),
                       mesh.faces.end(),
                       [&](const BoundaryFace &face) { return old_faces.count(face_key(face.nodes)) > 0; }),
        mesh.faces.end());
      for (auto c = gone.rbegin(); c != gone.rend(); ++c)
        mesh.cells.erase(mesh.cells.begin() + *c);
    }
  } // namespace

  unsigned int take_away_surface_slivers(TetMesh &mesh, const double limit)
  {
    unsigned int n = 0;
    for (;;)
    {
      const Boundary boundary(mesh);
      const auto     gone = slivers(mesh, boundary, limit);
      if (gone.empty())
        return n;
      take_away(mesh, gone, boundary);
      n += gone.size();
    }
  }
} // namespace retroforge
