// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/geometry/vector_algebra.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/transfer/gradient_fit.h>
#include <retroforge/transfer/recovered_gradient.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    // With fewer nodes around the next ones count, too: about one and a half times the unknowns.
    constexpr std::size_t enough_inside = 14, enough_on_patch = 7, enough_on_ridge = 2;
    // Faces that turn by more from the mean normal make an edge, across which there is no gradient.
    constexpr double sharp_cosine = 0.85;

    const std::array<NodeIndex, 4> &nodes_of(const std::array<NodeIndex, 4> &cell)
    {
      return cell;
    }

    const std::array<NodeIndex, 3> &nodes_of(const BoundaryFace &face)
    {
      return face.nodes;
    }

    // Numbers of the cells or faces at each node, ascending.
    template <typename Item>
    Rows<unsigned int> items_at_nodes(const std::vector<Item> &items, const unsigned int n_nodes)
    {
      Rows<unsigned int> rows;
      rows.begin.assign(n_nodes + 1, 0);
      for (const Item &item : items)
        for (const NodeIndex node : nodes_of(item))
          ++rows.begin[node + 1];
      for (unsigned int node = 0; node < n_nodes; ++node)
        rows.begin[node + 1] += rows.begin[node];
      rows.entries.resize(rows.begin.back());
      std::vector<unsigned int> next = rows.begin;
      for (unsigned int i = 0; i < items.size(); ++i)
        for (const NodeIndex node : nodes_of(items[i]))
          rows.entries[next[node]++] = i;
      return rows;
    }

    void make_unique(std::vector<NodeIndex> &nodes, const NodeIndex without)
    {
      std::sort(nodes.begin(), nodes.end());
      nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
      nodes.erase(std::remove(nodes.begin(), nodes.end(), without), nodes.end());
    }

    // The neighbours of a node, and theirs when they are not enough. `around` adds those of a node.
    template <typename Around>
    std::vector<NodeIndex> neighbourhood(const NodeIndex a, const std::size_t enough, const Around &around)
    {
      std::vector<NodeIndex> nodes;
      around(a, nodes);
      make_unique(nodes, a);
      if (nodes.size() < enough)
      {
        for (const NodeIndex b : std::vector<NodeIndex>(nodes))
          around(b, nodes);
        make_unique(nodes, a);
      }
      return nodes;
    }
  } // namespace

  RecoveredGradient::RecoveredGradient(const TetMesh &mesh, const NodalVectors<double> &X)
      : mesh_(mesh)
      , X_(X)
      , cells_at_(items_at_nodes(mesh.cells, mesh.n_nodes()))
      , faces_at_(items_at_nodes(mesh.faces, mesh.n_nodes()))
  {
  }

  bool RecoveredGradient::stencil_inside(const NodeIndex a, Stencil &stencil) const
  {
    for (const CellIndex c : cells_at_[a])
      if (!(tet_volume(corners(mesh_.cells[c], X_)) > 0))
        return false;
    stencil.nodes = neighbourhood(a, enough_inside, [&](const NodeIndex b, std::vector<NodeIndex> &nodes) {
      for (const CellIndex c : cells_at_[b])
        nodes.insert(nodes.end(), mesh_.cells[c].begin(), mesh_.cells[c].end());
    });
    stencil.directions = {Vec3({1, 0, 0}), Vec3({0, 1, 0}), Vec3({0, 0, 1})};
    return true;
  }

  bool
  RecoveredGradient::stencil_on_patch(const NodeIndex a, const unsigned int patch, Stencil &stencil) const
  {
    std::vector<Vec3> normals;
    Vec3              mean;
    stencil.nodes = neighbourhood(a, enough_on_patch, [&](const NodeIndex b, std::vector<NodeIndex> &nodes) {
      for (const unsigned int f : faces_at_[b])
        if (const BoundaryFace &face = mesh_.faces[f]; face.patch == patch)
        {
          nodes.insert(nodes.end(), face.nodes.begin(), face.nodes.end());
          const Vec3 &x = X_[face.nodes[0]];
          normals.push_back(cross_product_3d(X_[face.nodes[1]] - x, X_[face.nodes[2]] - x));
          mean += normals.back();
        }
    });
    for (const Vec3 &normal : normals)
      if (!(normal * mean > sharp_cosine * normal.norm() * mean.norm()))
        return false;
    const auto across  = directions_across(mean / mean.norm());
    stencil.directions = {across[0], across[1]};
    return true;
  }

  bool RecoveredGradient::stencil_on_ridge(const NodeIndex a, const PatchSet &patches, Stencil &stencil) const
  {
    const auto around = [&](const NodeIndex b, std::vector<NodeIndex> &nodes) {
      // An edge of the ridge is part of a face of each of the two patches.
      std::vector<NodeIndex> of_first, of_second;
      for (const unsigned int f : faces_at_[b])
        if (const BoundaryFace &face = mesh_.faces[f]; face.patch == patches[0])
          of_first.insert(of_first.end(), face.nodes.begin(), face.nodes.end());
        else if (face.patch == patches[1])
          of_second.insert(of_second.end(), face.nodes.begin(), face.nodes.end());
      make_unique(of_first, b);
      make_unique(of_second, b);
      std::set_intersection(
        of_first.begin(), of_first.end(), of_second.begin(), of_second.end(), std::back_inserter(nodes));
    };
    stencil.nodes = neighbourhood(a, enough_on_ridge, around);
    if (stencil.nodes.size() < enough_on_ridge)
      return false;
    // Along the chord of the whole.
    Vec3 chord;
    for (const NodeIndex b : stencil.nodes)
      if (const Vec3 d = X_[b] - X_[stencil.nodes[0]]; d.norm_square() > chord.norm_square())
        chord = d;
    stencil.directions = {chord / chord.norm()};
    return true;
  }

  bool RecoveredGradient::add_directional(const NodeIndex a,
                                          const PatchSet &patches,
                                          const Vec3     &direction,
                                          Row            &row) const
  {
    Stencil stencil;
    if (!(patches.empty()       ? stencil_inside(a, stencil)
          : patches.size() == 1 ? stencil_on_patch(a, patches[0], stencil)
                                : stencil_on_ridge(a, patches, stencil)))
      return false;
    const unsigned int n          = stencil.directions.size();
    const auto         components = [&](const Vec3 &v) {
      Vec3 c;
      for (unsigned int i = 0; i < n; ++i)
        c[i] = v * stencil.directions[i];
      return c;
    };
    std::vector<Vec3> points;
    for (const NodeIndex b : stencil.nodes)
      points.push_back(components(X_[b] - X_[a]));
    const auto coefficients = fitted_derivative(points, n, components(direction));
    if (!coefficients)
      return false;
    for (std::size_t b = 0; b < stencil.nodes.size(); ++b)
    {
      row.emplace_back(stencil.nodes[b], (*coefficients)[b]);
      row.emplace_back(a, -(*coefficients)[b]);
    }
    return true;
  }
} // namespace retroforge
