// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/topology.h>

#include <algorithm>
#include <utility>

namespace retroforge
{
  namespace
  {
    // Rows from (row, entry) pairs, sorted and without duplicates.
    Rows<unsigned int> make_rows(std::vector<std::pair<unsigned int, unsigned int>> pairs,
                                 const unsigned int                                 n_rows)
    {
      std::sort(pairs.begin(), pairs.end());
      pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
      Rows<unsigned int> rows;
      rows.begin.assign(n_rows + 1, 0);
      for (const auto &[row, entry] : pairs)
      {
        ++rows.begin[row + 1];
        rows.entries.push_back(entry);
      }
      for (unsigned int row = 0; row < n_rows; ++row)
        rows.begin[row + 1] += rows.begin[row];
      return rows;
    }

    Rows<unsigned int> surface_faces_at_nodes(const TetMesh &mesh)
    {
      std::vector<std::pair<unsigned int, unsigned int>> pairs;
      for (unsigned int f = 0; f < mesh.faces.size(); ++f)
        if (mesh.is_surface(mesh.faces[f]))
          for (const NodeIndex node : mesh.faces[f].nodes)
            pairs.emplace_back(node, f);
      return make_rows(std::move(pairs), mesh.n_nodes());
    }

    std::vector<std::array<NodeIndex, 2>> edges_of_surface(const TetMesh &mesh)
    {
      std::vector<std::array<NodeIndex, 2>> edges;
      for (const BoundaryFace &face : mesh.faces)
        if (mesh.is_surface(face))
          for (unsigned int e = 0; e < 3; ++e)
          {
            const auto [a, b] = std::minmax(face.nodes[e], face.nodes[(e + 1) % 3]);
            edges.push_back({{a, b}});
          }
      std::sort(edges.begin(), edges.end());
      edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
      return edges;
    }

    Rows<CellIndex> cells_at_nodes(const TetMesh &mesh)
    {
      std::vector<std::pair<unsigned int, unsigned int>> pairs;
      pairs.reserve(4 * mesh.cells.size());
      for (CellIndex c = 0; c < mesh.n_cells(); ++c)
        for (const NodeIndex node : mesh.cells[c])
          pairs.emplace_back(node, c);
      return make_rows(std::move(pairs), mesh.n_nodes());
    }

    Rows<NodeIndex> neighbours_of_nodes(const TetMesh &mesh, const Rows<CellIndex> &cells)
    {
      Rows<NodeIndex>        rows;
      std::vector<NodeIndex> near;
      for (NodeIndex node = 0; node < mesh.n_nodes(); ++node)
      {
        near.assign(1, node);
        for (const CellIndex c : cells[node])
          near.insert(near.end(), mesh.cells[c].begin(), mesh.cells[c].end());
        std::sort(near.begin(), near.end());
        near.erase(std::unique(near.begin(), near.end()), near.end());
        rows.entries.insert(rows.entries.end(), near.begin(), near.end());
        rows.begin.push_back(rows.entries.size());
      }
      return rows;
    }

    // Appends the part of `normal` across the directions from `first` on, unless it is already fixed.
    void orthonormalise_into(std::vector<Vec3> &directions, const std::size_t first, Vec3 normal)
    {
      for (unsigned int pass = 0; pass < 2; ++pass)
        for (std::size_t i = first; i < directions.size(); ++i)
          normal -= (normal * directions[i]) * directions[i];
      if (normal.norm() > 1e-6)
        directions.push_back(normal / normal.norm());
    }

    Rows<Vec3> fixed_directions_of_nodes(const TetMesh &mesh)
    {
      std::vector<std::pair<unsigned int, unsigned int>> pairs;
      for (const auto &face : mesh.faces)
        if (!mesh.is_surface(face))
          for (const NodeIndex node : face.nodes)
            pairs.emplace_back(node, face.patch);
      const auto patches = make_rows(std::move(pairs), mesh.n_nodes());

      Rows<Vec3> rows;
      for (NodeIndex node = 0; node < mesh.n_nodes(); ++node)
      {
        for (const unsigned int patch : patches[node])
          orthonormalise_into(rows.entries, rows.begin.back(), mesh.patches[patch].symmetry->normal);
        rows.begin.push_back(rows.entries.size());
      }
      return rows;
    }
  } // namespace

  Topology::Topology(const TetMesh &mesh)
      : surface_faces(surface_faces_at_nodes(mesh))
      , surface_edges(edges_of_surface(mesh))
      , cells(cells_at_nodes(mesh))
      , neighbours(neighbours_of_nodes(mesh, cells))
      , fixed_directions(fixed_directions_of_nodes(mesh))
  {
  }
} // namespace retroforge
