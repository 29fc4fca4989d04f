// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/mesh/cell_faces.h>
#include <retroforge/mesh/mesh_checks.h>
#include <retroforge/mesh/mesh_quality.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <sstream>
#include <utility>

namespace retroforge
{
  namespace
  {
    const std::string repair = "repair the mesh, or mesh the part anew";

    std::string in_words(const Vec3 &x)
    {
      std::ostringstream out;
      out << "(" << x[0] << ", " << x[1] << ", " << x[2] << ")";
      return out.str();
    }

    std::string face_in_words(const TetMesh &mesh, const std::array<NodeIndex, 3> &nodes)
    {
      std::ostringstream out;
      out << nodes[0] << "-" << nodes[1] << "-" << nodes[2] << " at "
          << in_words((mesh.X[nodes[0]] + mesh.X[nodes[1]] + mesh.X[nodes[2]]) / 3.);
      return out.str();
    }

    void check_indices(const TetMesh &mesh, const std::string &where)
    {
      for (CellIndex c = 0; c < mesh.n_cells(); ++c)
        for (const NodeIndex node : mesh.cells[c])
          if (node >= mesh.n_nodes())
            throw Error(where,
                        "tetrahedron " + std::to_string(c) + " refers to node " + std::to_string(node),
                        "the mesh has " + std::to_string(mesh.n_nodes()) + " nodes, counted from 0",
                        repair);
      for (std::size_t f = 0; f < mesh.faces.size(); ++f)
      {
        for (const NodeIndex node : mesh.faces[f].nodes)
          if (node >= mesh.n_nodes())
            throw Error(where,
                        "boundary face " + std::to_string(f) + " refers to node " + std::to_string(node),
                        "the mesh has " + std::to_string(mesh.n_nodes()) + " nodes, counted from 0",
                        repair);
        if (mesh.faces[f].patch >= mesh.patches.size())
          throw Error(where,
                      "boundary face " + std::to_string(f) + " is on patch " +
                        std::to_string(mesh.faces[f].patch),
                      "the mesh has " + std::to_string(mesh.patches.size()) + " patches, counted from 0",
                      repair);
      }
    }

    void check_positions(const TetMesh &mesh, const std::string &where)
    {
      for (NodeIndex node = 0; node < mesh.n_nodes(); ++node)
        for (unsigned int d = 0; d < 3; ++d)
          if (!std::isfinite(mesh.X[node][d]))
            throw Error(where,
                        "node " + std::to_string(node) + " is at " + in_words(mesh.X[node]),
                        "coordinates must be finite numbers",
                        repair);
    }

    bool is_degenerate(const TetCorners &x)
    {
      double square = 0;
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int b = a + 1; b < 4; ++b)
          square = std::max(square, (x[a] - x[b]).norm_square());
      return !(6 * tet_volume(x) > 1e-10 * square * std::sqrt(square));
    }

    void check_volumes(const TetMesh &mesh, const std::string &where)
    {
      std::vector<CellIndex> bad;
      for (CellIndex c = 0; c < mesh.n_cells(); ++c)
        if (is_degenerate(corners(mesh.cells[c], mesh.X)))
          bad.push_back(c);
      if (bad.empty())
        return;
      std::ostringstream what;
      what << bad.size() << " of " << mesh.n_cells() << " tetrahedra are inverted or degenerate:";
      for (std::size_t i = 0; i < std::min<std::size_t>(bad.size(), 3); ++i)
      {
        const auto x = corners(mesh.cells[bad[i]], mesh.X);
        what << (i == 0 ? " " : ", ") << "number " << bad[i] << " with volume " << tet_volume(x) << " at "
             << in_words((x[0] + x[1] + x[2] + x[3]) / 4.);
      }
      what << (bad.size() > 3 ? ", ..." : "");
      throw Error(where, what.str(), "every tetrahedron must have a positive volume", repair);
    }

    void check_all_nodes_used(const TetMesh &mesh, const std::string &where)
    {
      std::vector<bool> used(mesh.n_nodes(), false);
      for (const auto &cell : mesh.cells)
        for (const NodeIndex node : cell)
          used[node] = true;
      const auto unused = std::find(used.begin(), used.end(), false);
      if (unused != used.end())
        throw Error(where,
                    std::to_string(std::count(used.begin(), used.end(), false)) +
                      " nodes belong to no tetrahedron, the first is node " +
                      std::to_string(unused - used.begin()),
                    "every node must be a corner of a tetrahedron",
                    "remove the nodes that are not used");
    }

    bool same_turn(const std::array<NodeIndex, 3> &a, const std::array<NodeIndex, 3> &b)
    {
      for (unsigned int shift = 0; shift < 3; ++shift)
        if (a[0] == b[shift] && a[1] == b[(shift + 1) % 3] && a[2] == b[(shift + 2) % 3])
          return true;
      return false;
    }

    // Outward faces of two cells on either side of a face turn opposite ways; alike, the cells overlap.
    void check_neighbours(const TetMesh &mesh, const std::string &where)
    {
      const auto faces = sorted_cell_faces(mesh.cells);
      for (std::size_t i = 1; i < faces.size(); ++i)
        if (faces[i - 1].key == faces[i].key)
        {
          if (i > 1 && faces[i - 2].key == faces[i].key)
            throw Error(where,
                        "tetrahedra " + std::to_string(faces[i - 2].cell) + ", " +
                          std::to_string(faces[i - 1].cell) + " and " + std::to_string(faces[i].cell) +
                          " share the face " + face_in_words(mesh, faces[i].nodes),
                        "at most two tetrahedra may share a face",
                        repair);
          const bool is_last = i + 1 == faces.size() || faces[i + 1].key != faces[i].key;
          if (is_last && same_turn(faces[i - 1].nodes, faces[i].nodes))
            throw Error(where,
                        "tetrahedra " + std::to_string(faces[i - 1].cell) + " and " +
                          std::to_string(faces[i].cell) + " lie on the same side of their common face " +
                          face_in_words(mesh, faces[i].nodes),
                        "tetrahedra must not overlap",
                        repair);
        }
    }

    CellIndex body_of(std::vector<CellIndex> &next, CellIndex c)
    {
      while (next[c] != c)
        c = next[c] = next[next[c]];
      return c;
    }

    // Each tetrahedron leads, by way of others, to the first one of its body.
    void check_connected(const TetMesh &mesh, const std::string &where)
    {
      std::vector<CellIndex> next(mesh.n_cells());
      std::iota(next.begin(), next.end(), 0);
      const auto faces = sorted_cell_faces(mesh.cells);
      for (std::size_t i = 1; i < faces.size(); ++i)
        if (faces[i - 1].key == faces[i].key)
        {
          const auto [first, second] =
            std::minmax({body_of(next, faces[i - 1].cell), body_of(next, faces[i].cell)});
          next[second] = first;
        }
      for (CellIndex c = 0; c < mesh.n_cells(); ++c)
        if (body_of(next, c) != 0)
          throw Error(
            where,
            "tetrahedra 0 at " + in_words(mesh.X[mesh.cells[0][0]]) + " and " + std::to_string(c) + " at " +
              in_words(mesh.X[mesh.cells[c][0]]) + " belong to bodies that no face connects",
            "a workpiece is one body, and is given once",
            "keep one of the bodies, or join them by merging the nodes that stand in the same place");
    }

    // Sorted index of the listed boundary faces; throws when two are the same.
    std::vector<std::pair<FaceKey, std::size_t>> listed_faces(const TetMesh &mesh, const std::string &where)
    {
      std::vector<std::pair<FaceKey, std::size_t>> listed;
      for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        listed.emplace_back(face_key(mesh.faces[f].nodes), f);
      std::sort(listed.begin(), listed.end());
      for (std::size_t i = 1; i < listed.size(); ++i)
        if (listed[i - 1].first == listed[i].first)
          throw Error(where,
                      "the boundary face " + face_in_words(mesh, mesh.faces[listed[i].second].nodes) +
                        " is listed more than once",
                      "each boundary face belongs to one patch",
                      "remove the duplicate");
      return listed;
    }

    // Both lists are sorted by key, so one walk finds what is in one and not in the other.
    void check_boundary(const TetMesh &mesh, const std::string &where)
    {
      const auto boundary = boundary_cell_faces(mesh.cells);
      const auto listed   = listed_faces(mesh, where);
      auto       cell     = boundary.begin();
      for (const auto &[key, f] : listed)
      {
        const auto &nodes = mesh.faces[f].nodes;
        if (cell != boundary.end() && cell->key < key)
          break;
        if (cell == boundary.end() || cell->key != key)
          throw Error(where,
                      "the boundary face " + face_in_words(mesh, nodes) +
                        " is not the outer face of a tetrahedron",
                      "a boundary face must be a face of exactly one tetrahedron",
                      repair);
        if (!same_turn(cell->nodes, nodes))
          throw Error(where,
                      "the boundary face " + face_in_words(mesh, nodes) + " turns the wrong way",
                      "its nodes must turn counter-clockwise seen from outside",
                      "exchange two of its nodes");
        ++cell;
      }
      if (cell != boundary.end())
        throw Error(where,
                    "the face " + face_in_words(mesh, cell->nodes) + " of tetrahedron " +
                      std::to_string(cell->cell) + " has no neighbour and is not listed as a boundary face",
                    "the boundary must be closed",
                    repair);
    }

    using Edge = std::pair<NodeIndex, NodeIndex>;

    void check_edges(const TetMesh &mesh, const std::string &where)
    {
      std::vector<Edge> edges;
      for (const auto &face : mesh.faces)
        for (unsigned int i = 0; i < 3; ++i)
          edges.push_back(std::minmax({face.nodes[i], face.nodes[(i + 1) % 3]}));
      std::sort(edges.begin(), edges.end());
      for (std::size_t first = 0, last; first < edges.size(); first = last)
      {
        last = first;
        while (last < edges.size() && edges[last] == edges[first])
          ++last;
        if (last - first != 2)
          throw Error(where,
                      std::to_string(last - first) + " boundary faces meet at the edge " +
                        std::to_string(edges[first].first) + "-" + std::to_string(edges[first].second) +
                        " at " + in_words((mesh.X[edges[first].first] + mesh.X[edges[first].second]) / 2.),
                      "the boundary must be a manifold, with two faces at every edge",
                      "separate the parts that touch along this edge, or join them");
      }
    }

    // Walks round the node from face to face; all its faces must be met.
    bool is_one_fan(const std::vector<std::array<NodeIndex, 3>> &faces, const NodeIndex node)
    {
      std::map<NodeIndex, NodeIndex> next;
      for (const auto &nodes : faces)
        for (unsigned int i = 0; i < 3; ++i)
          if (nodes[i] == node)
            next[nodes[(i + 1) % 3]] = nodes[(i + 2) % 3];
      const NodeIndex start  = next.begin()->first;
      std::size_t     walked = 0;
      NodeIndex       at     = start;
      do
      {
        const auto step = next.find(at);
        if (step == next.end())
          return false;
        at = step->second;
        ++walked;
      } while (at != start && walked <= faces.size());
      return walked == faces.size();
    }

    void check_fans(const TetMesh &mesh, const std::string &where)
    {
      std::vector<std::vector<std::array<NodeIndex, 3>>> faces_at(mesh.n_nodes());
      for (const auto &face : mesh.faces)
        for (const NodeIndex node : face.nodes)
          faces_at[node].push_back(face.nodes);
      for (NodeIndex node = 0; node < mesh.n_nodes(); ++node)
        if (!faces_at[node].empty() && !is_one_fan(faces_at[node], node))
          throw Error(where,
                      "parts of the boundary touch at the single node " + std::to_string(node) + " at " +
                        in_words(mesh.X[node]),
                      "the boundary must be a manifold, with one fan of faces at every node",
                      "separate the parts that touch at this node, or join them");
    }
  } // namespace

  void check_mesh(const TetMesh &mesh, const std::string &where)
  {
    if (mesh.cells.empty())
      throw Error(where,
                  "there are no tetrahedra",
                  "a workpiece is a mesh of tetrahedra",
                  "make a volume mesh, and save its volume elements");
    check_indices(mesh, where);
    check_positions(mesh, where);
    check_volumes(mesh, where);
    check_all_nodes_used(mesh, where);
    check_neighbours(mesh, where);
    check_boundary(mesh, where);
    check_edges(mesh, where);
    check_fans(mesh, where);
    check_connected(mesh, where);
  }
} // namespace retroforge
