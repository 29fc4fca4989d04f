// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/remeshing/peeled_mesh.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    using Cell = std::array<NodeIndex, 4>;
  } // namespace

  PeeledMesh::PeeledMesh(const TetMesh &mesh, const NodalVectors<double> &X) : mesh_(mesh)
  {
    mesh_.X = X;
    find_boundary();
  }

  double PeeledMesh::volume(const CellIndex c) const
  {
    return tet_volume(corners(mesh_.cells[c], mesh_.X));
  }

  FaceKey PeeledMesh::face_of(const CellIndex c, const unsigned int opposite) const
  {
    const auto &corner = tet_face_corners[opposite];
    const Cell &cell   = mesh_.cells[c];
    return face_key({{cell[corner[0]], cell[corner[1]], cell[corner[2]]}});
  }

  void PeeledMesh::find_boundary()
  {
    cell_behind_.clear();
    boundary_nodes_.clear();
    boundary_edges_.clear();
    for (const CellFace &face : boundary_cell_faces(mesh_.cells))
    {
      cell_behind_[face.key] = face.cell;
      for (unsigned int i = 0; i < 3; ++i)
      {
        boundary_nodes_.insert(face.nodes[i]);
        boundary_edges_.insert(edge_key(face.nodes[i], face.nodes[(i + 1) % 3]));
      }
    }
  }

  std::vector<CellIndex> PeeledMesh::surface_cells_beside(const CellIndex cell) const
  {
    std::set<FaceKey> faces;
    for (unsigned int a = 0; a < 4; ++a)
      faces.insert(face_of(cell, a));
    std::set<std::pair<double, CellIndex>> found;
    for (const BoundaryFace &face : mesh_.faces)
      if (const CellIndex c = cell_behind(face.nodes); mesh_.is_surface(face) && c != cell)
        for (unsigned int a = 0; a < 4; ++a)
          if (faces.count(face_of(c, a)) > 0)
            found.insert({volume(c), c});
    std::vector<CellIndex> cells;
    for (const auto &[volume, c] : found)
      cells.push_back(c);
    return cells;
  }

  bool PeeledMesh::remove_first(const std::vector<CellIndex> &cells, const double most)
  {
    const auto cell = std::find_if(cells.begin(), cells.end(), [&](const CellIndex c) { return may_go(c); });
    if (cell == cells.end() || removed_ + volume(*cell) > most)
      return false;
    removed_ += volume(*cell);
    remove(*cell);
    return true;
  }

  // What comes to the boundary must not be on it yet.
  bool PeeledMesh::may_go(const CellIndex c) const
  {
    std::vector<unsigned int> on, off; // corners opposite faces on the boundary, and not
    for (unsigned int a = 0; a < 4; ++a)
      (cell_behind_.count(face_of(c, a)) ? on : off).push_back(a);
    const Cell &cell = mesh_.cells[c];
    switch (on.size())
    {
      case 1:
        return boundary_nodes_.count(cell[on[0]]) == 0;
      case 2: // the edge between the corners opposite them is not shared by them
        return boundary_edges_.count(edge_key(cell[on[0]], cell[on[1]])) == 0;
      case 3:
        return true;
      default:
        return false;
    }
  }

  void PeeledMesh::remove(const CellIndex c)
  {
    std::map<FaceKey, unsigned int> patch;
    unsigned int                    surface = 0;
    for (const BoundaryFace &face : mesh_.faces)
      patch[face_key(face.nodes)] = face.patch;
    std::set<FaceKey> gone;
    for (unsigned int a = 0; a < 4; ++a)
      if (const auto found = patch.find(face_of(c, a)); found != patch.end())
      {
        gone.insert(found->first);
        if (!mesh_.patches[found->second].symmetry)
          surface = found->second;
      }
    mesh_.faces.erase(
      std::remove_if(mesh_.faces.begin(),
                     mesh_.faces.end(),
                     [&](const BoundaryFace &face) { return gone.count(face_key(face.nodes)) > 0; }),
      mesh_.faces.end());
    for (unsigned int a = 0; a < 4; ++a)
      if (gone.count(face_of(c, a)) == 0)
      {
        const auto &corner = tet_face_corners[a]; // turned: the cell was inside, and is outside now
        const Cell &cell   = mesh_.cells[c];
        mesh_.faces.push_back({{{cell[corner[0]], cell[corner[2]], cell[corner[1]]}}, surface});
      }
    mesh_.cells.erase(mesh_.cells.begin() + c);
    find_boundary();
  }

  RepairedMesh PeeledMesh::result() const
  {
    RepairedMesh           made{{mesh_, {}}, removed_};
    TetMesh               &mesh = made.mesh.mesh;
    std::vector<NodeIndex> number(mesh_.n_nodes(), invalid_index);
    for (const Cell &cell : mesh_.cells)
      for (const NodeIndex k : cell)
        number[k] = 0;
    mesh.X.clear();
    for (NodeIndex k = 0; k < number.size(); ++k)
      if (number[k] != invalid_index)
      {
        number[k] = mesh.X.size();
        made.mesh.old_node.push_back(k);
        mesh.X.push_back(mesh_.X[k]);
      }
    for (Cell &cell : mesh.cells)
      for (NodeIndex &k : cell)
        k = number[k];
    for (BoundaryFace &face : mesh.faces)
      for (NodeIndex &k : face.nodes)
        k = number[k];
    return made;
  }
} // namespace retroforge
