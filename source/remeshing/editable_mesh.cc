// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/remeshing/editable_mesh.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    void erase_value(std::vector<unsigned int> &list, const unsigned int value)
    {
      list.erase(std::find(list.begin(), list.end(), value));
    }
  } // namespace

  EditableMesh::EditableMesh(const TetMesh              &mesh,
                             const NodalVectors<double> &X,
                             const SurfaceFeatures      &features)
      : X_(X)
      , cells_at_(X.size())
      , faces_at_(X.size())
      , ridges_at_(X.size())
      , is_corner_(features.is_corner)
      , is_moved_(X.size(), false)
      , last_change_(X.size(), 0)
  {
    for (auto &list : cells_at_)
      list.reserve(32);
    for (const auto &cell : mesh.cells)
      add_cell(cell);
    for (unsigned int f = 0; f < mesh.faces.size(); ++f)
      add_face({mesh.faces[f].nodes, features.region_of_face[f]});
    for (unsigned int c = 0; c < features.curves.size(); ++c)
      for (std::size_t i = 0; i + 1 < features.curves[c].nodes.size(); ++i)
        add_ridge({{{features.curves[c].nodes[i], features.curves[c].nodes[i + 1]}}, c});
    std::fill(last_change_.begin(), last_change_.end(), 0);
  }

  NodeKind EditableMesh::kind(const NodeIndex node) const
  {
    if (faces_at_[node].empty())
      return NodeKind::interior;
    if (is_corner_[node])
      return NodeKind::corner;
    return ridges_at_[node].empty() ? NodeKind::surface : NodeKind::ridge;
  }

  std::vector<CellIndex> EditableMesh::cells_at_edge(const NodeIndex a, const NodeIndex b) const
  {
    std::vector<CellIndex> found;
    for (const CellIndex c : cells_at_[a])
      if (contains(cells_[c], b))
        found.push_back(c);
    return found;
  }

  std::vector<unsigned int> EditableMesh::faces_at_edge(const NodeIndex a, const NodeIndex b) const
  {
    std::vector<unsigned int> found;
    for (const unsigned int f : faces_at_[a])
      if (contains(faces_[f].nodes, b))
        found.push_back(f);
    return found;
  }

  bool EditableMesh::is_edge(const NodeIndex a, const NodeIndex b) const
  {
    for (const CellIndex c : cells_at_[a])
      if (contains(cells_[c], b))
        return true;
    return false;
  }

  unsigned int EditableMesh::curve_of_edge(const NodeIndex a, const NodeIndex b) const
  {
    for (const Ridge &ridge : ridges_at_[a])
      if (contains(ridge.nodes, b))
        return ridge.curve;
    return invalid_index;
  }

  std::vector<NodeIndex> EditableMesh::neighbours(const NodeIndex node) const
  {
    std::vector<NodeIndex> found;
    for (const CellIndex c : cells_at_[node])
      for (const NodeIndex other : cells_[c])
        if (other != node)
          found.push_back(other);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

  void EditableMesh::apply(const CavityChange &change)
  {
    if (change.placed_node == n_nodes())
    {
      X_.push_back(change.position);
      cells_at_.emplace_back();
      faces_at_.emplace_back();
      ridges_at_.emplace_back();
      is_corner_.push_back(false);
      is_moved_.push_back(true);
      last_change_.push_back(0);
    }
    else if (change.placed_node != invalid_index)
    {
      X_[change.placed_node]        = change.position;
      is_moved_[change.placed_node] = true;
    }
    for (const CellIndex cell : change.removed_cells)
      remove_cell(cell);
    for (const unsigned int face : change.removed_faces)
      remove_face(face);
    for (const Ridge &ridge : change.removed_ridges)
      remove_ridge(ridge);
    for (const Cell &cell : change.added_cells)
      add_cell(cell);
    for (const SurfaceFace &face : change.added_faces)
      add_face(face);
    for (const Ridge &ridge : change.added_ridges)
      add_ridge(ridge);
  }

  void EditableMesh::add_cell(const Cell &cell)
  {
    const CellIndex index = cells_.size();
    cells_.push_back(cell);
    quality_.push_back(tet_quality(corners(cell, X_)));
    for (const NodeIndex node : cell)
    {
      cells_at_[node].push_back(index);
      last_change_[node] = index + 1;
    }
  }

  void EditableMesh::remove_cell(const CellIndex cell)
  {
    for (const NodeIndex node : cells_[cell])
    {
      erase_value(cells_at_[node], cell);
      last_change_[node] = cells_.size() + 1;
    }
    cells_[cell][0] = invalid_index;
  }

  void EditableMesh::add_face(const SurfaceFace &face)
  {
    for (const NodeIndex node : face.nodes)
      faces_at_[node].push_back(faces_.size());
    faces_.push_back(face);
  }

  void EditableMesh::remove_face(const unsigned int face)
  {
    for (const NodeIndex node : faces_[face].nodes)
      erase_value(faces_at_[node], face);
    faces_[face].nodes[0] = invalid_index;
  }

  void EditableMesh::add_ridge(const Ridge &ridge)
  {
    for (const NodeIndex node : ridge.nodes)
      ridges_at_[node].push_back(ridge);
  }

  void EditableMesh::remove_ridge(const Ridge &ridge)
  {
    for (const NodeIndex node : ridge.nodes)
    {
      auto &list = ridges_at_[node];
      list.erase(std::find_if(list.begin(), list.end(), [&](const Ridge &other) {
        return contains(other.nodes, ridge.nodes[0]) && contains(other.nodes, ridge.nodes[1]);
      }));
    }
  }

  std::vector<NodeIndex> order_of_compacted(const EditableMesh &edited)
  {
    std::vector<NodeIndex> order;
    for (const bool moved : {false, true})
      for (NodeIndex node = 0; node < edited.n_nodes(); ++node)
        if (edited.is_used(node) && edited.is_moved(node) == moved)
          order.push_back(node);
    return order;
  }

  TetMesh
  compacted(const EditableMesh &edited, const SurfaceFeatures &features, std::vector<NodeIndex> &old_node)
  {
    old_node.clear();
    std::vector<NodeIndex> number(edited.n_nodes(), invalid_index);
    TetMesh                mesh;
    for (const NodeIndex node : order_of_compacted(edited))
    {
      number[node] = mesh.X.size();
      mesh.X.push_back(edited.X(node));
      old_node.push_back(edited.is_moved(node) ? invalid_index : node);
    }
    for (CellIndex c = 0; c < edited.n_cells(); ++c)
      if (edited.is_alive(c))
      {
        const Cell &n = edited.cell(c);
        mesh.cells.push_back({{number[n[0]], number[n[1]], number[n[2]], number[n[3]]}});
      }
    for (unsigned int f = 0; f < edited.n_faces(); ++f)
      if (edited.is_face_alive(f))
      {
        const auto &n = edited.face(f).nodes;
        mesh.faces.push_back(
          {{{number[n[0]], number[n[1]], number[n[2]]}}, features.patch_of_region[edited.face(f).region]});
      }
    return mesh;
  }
} // namespace retroforge
