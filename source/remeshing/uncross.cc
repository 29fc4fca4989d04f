// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/cell_faces.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/mesh/self_crossing.h>
#include <retroforge/remeshing/uncross.h>

#include <algorithm>
#include <map>
#include <set>

namespace retroforge
{
  namespace
  {
    using Cell = std::array<NodeIndex, 4>;
    using Edge = std::array<NodeIndex, 2>;

    Edge edge(const NodeIndex a, const NodeIndex b)
    {
      return {{std::min(a, b), std::max(a, b)}};
    }

    /// A mesh whose cells at the boundary can be taken away.
    class Peeled
    {
    public:
      Peeled(const TetMesh &mesh, const NodalVectors<double> &X) : mesh_(mesh)
      {
        mesh_.X = X;
        find_boundary();
      }

      const TetMesh &mesh() const { return mesh_; }

      double volume(const CellIndex c) const { return tet_volume(corners(mesh_.cells[c], mesh_.X)); }

      /// Cells behind the crossing faces off the planes of symmetry, the smallest first.
      std::vector<CellIndex> candidates(const std::vector<SelfCrossing> &crossings) const
      {
        std::set<Edge>         edges;
        std::set<unsigned int> faces;
        for (const SelfCrossing &crossing : crossings)
        {
          edges.insert(crossing.edge);
          faces.insert(crossing.face);
        }
        std::vector<std::pair<double, CellIndex>> found;
        for (unsigned int f = 0; f < mesh_.faces.size(); ++f)
        {
          const auto &nodes   = mesh_.faces[f].nodes;
          bool        crosses = faces.count(f) > 0;
          for (unsigned int i = 0; i < 3; ++i)
            crosses = crosses || edges.count(edge(nodes[i], nodes[(i + 1) % 3])) > 0;
          if (crosses && mesh_.is_surface(mesh_.faces[f]))
            found.emplace_back(volume(cell_behind_.at(face_key(nodes))), cell_behind_.at(face_key(nodes)));
        }
        std::sort(found.begin(), found.end());
        std::vector<CellIndex> cells;
        for (const auto &[volume, cell] : found)
          if (cells.empty() || cells.back() != cell)
            cells.push_back(cell);
        return cells;
      }

      /// Whether the boundary stays a surface without the cell: what comes to it is not on it yet.
      bool may_go(const CellIndex c) const
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
            return boundary_edges_.count(edge(cell[on[0]], cell[on[1]])) == 0;
          case 3:
            return true;
          default:
            return false;
        }
      }

      void remove(const CellIndex c)
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

      /// Without the nodes that no cell has any more.
      RebuiltMesh compacted() const
      {
        RebuiltMesh            made{mesh_, {}};
        std::vector<NodeIndex> number(mesh_.n_nodes(), invalid_index);
        for (const Cell &cell : mesh_.cells)
          for (const NodeIndex k : cell)
            number[k] = 0;
        made.mesh.X.clear();
        for (NodeIndex k = 0; k < number.size(); ++k)
          if (number[k] != invalid_index)
          {
            number[k] = made.old_node.size();
            made.old_node.push_back(k);
            made.mesh.X.push_back(mesh_.X[k]);
          }
        for (Cell &cell : made.mesh.cells)
          for (NodeIndex &k : cell)
            k = number[k];
        for (BoundaryFace &face : made.mesh.faces)
          for (NodeIndex &k : face.nodes)
            k = number[k];
        return made;
      }

    private:
      FaceKey face_of(const CellIndex c, const unsigned int opposite) const
      {
        const auto &corner = tet_face_corners[opposite];
        const Cell &cell   = mesh_.cells[c];
        return face_key({{cell[corner[0]], cell[corner[1]], cell[corner[2]]}});
      }

      void find_boundary()
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
            boundary_edges_.insert(edge(face.nodes[i], face.nodes[(i + 1) % 3]));
          }
        }
      }

      TetMesh                      mesh_;
      std::map<FaceKey, CellIndex> cell_behind_; ///< of faces of the boundary
      std::set<NodeIndex>          boundary_nodes_;
      std::set<Edge>               boundary_edges_;
    };
  } // namespace

  std::optional<UncrossedMesh>
  uncross(const TetMesh &mesh, const NodalVectors<double> &X, const std::function<double(const Vec3 &)> &size)
  {
    if (self_crossings(mesh, X).empty())
      return {};
    Peeled peeled(mesh, X);
    double removed = 0.;
    for (;;)
    {
      const auto crossings = self_crossings(peeled.mesh(), X);
      if (crossings.empty())
        return UncrossedMesh{peeled.compacted(), removed};
      const double h     = size(X[crossings[0].edge[0]]);
      const auto   cells = peeled.candidates(crossings);
      const auto   cell =
        std::find_if(cells.begin(), cells.end(), [&](const CellIndex c) { return peeled.may_go(c); });
      if (cell == cells.end() || removed + peeled.volume(*cell) > h * h * h)
        return {};
      removed += peeled.volume(*cell);
      peeled.remove(*cell);
    }
  }
} // namespace retroforge
