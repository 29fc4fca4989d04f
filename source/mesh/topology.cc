// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/symmetry_directions.h>
#include <retroforge/mesh/topology.h>
#include <retroforge/mesh/whole_part.h>

#include <algorithm>
#include <cmath>
#include <iterator>
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

    // Those of symmetry, ascending, that each node lies on.
    Rows<unsigned int> planes_at_nodes(const TetMesh &mesh)
    {
      std::vector<std::pair<unsigned int, unsigned int>> pairs;
      for (const BoundaryFace &face : mesh.faces)
        if (!mesh.is_surface(face))
          for (const NodeIndex node : face.nodes)
            pairs.emplace_back(node, face.patch);
      return make_rows(std::move(pairs), mesh.n_nodes());
    }

    // Of a piece of the workpiece, around what lies on all of these planes, in the whole. Planes whose angle
    // is no whole part of a turn have no whole: one.
    double n_images(const TetMesh &mesh, const std::vector<unsigned int> &patches)
    {
      const double copies = patches.empty() ? 1. : n_copies(symmetry_planes(mesh, patches));
      return std::isfinite(copies) ? copies : 1.;
    }

    std::vector<std::array<unsigned int, 2>>
    images_of_edges(const TetMesh &mesh, const std::vector<std::array<NodeIndex, 2>> &edges)
    {
      const auto                               planes = planes_at_nodes(mesh);
      std::vector<std::array<unsigned int, 2>> images(edges.size(), {{1, 1}});
      for (std::size_t e = 0; e < edges.size(); ++e)
      {
        const auto a = planes[edges[e][0]], b = planes[edges[e][1]];
        if (a.size() + b.size() == 0)
          continue;
        std::vector<unsigned int> common;
        std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
        const double of_edge = n_images(mesh, common);
        for (unsigned int i = 0; i < 2; ++i)
        {
          const auto  &at   = i == 0 ? a : b;
          const double node = n_images(mesh, {at.begin(), at.end()});
          images[e][i]      = std::max(1., std::round(node / of_edge));
        }
      }
      return images;
    }
  } // namespace

  namespace
  {
    std::vector<CellIndex> cells_of_faces(const TetMesh &mesh, const Rows<CellIndex> &cells)
    {
      std::vector<CellIndex> of_face(mesh.faces.size(), invalid_index);
      for (std::size_t f = 0; f < mesh.faces.size(); ++f)
      {
        const auto &corners = mesh.faces[f].nodes;
        for (const CellIndex c : cells[corners[0]])
          if (const auto &nodes = mesh.cells[c];
              std::all_of(corners.begin(), corners.end(), [&](const NodeIndex k) {
                return std::find(nodes.begin(), nodes.end(), k) != nodes.end();
              }))
          {
            of_face[f] = c;
            break;
          }
      }
      return of_face;
    }
  } // namespace

  Topology::Topology(const TetMesh &mesh)
      : surface_faces(surface_faces_at_nodes(mesh))
      , surface_edges(edges_of_surface(mesh))
      , edge_images(images_of_edges(mesh, surface_edges))
      , cells(cells_at_nodes(mesh))
      , cell_of_face(cells_of_faces(mesh, cells))
      , neighbours(neighbours_of_nodes(mesh, cells))
      , fixed_directions(
          symmetry_directions(mesh, mesh.n_nodes(), [](const BoundaryFace &face) { return face.nodes; }))
  {
  }
} // namespace retroforge
