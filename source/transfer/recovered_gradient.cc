// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/dual.h>
#include <retroforge/geometry/vector_algebra.h>
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
    // Stencils with their fits that are kept: 3 kB each.
    constexpr std::size_t most_stencils = 4000;

    template <typename Number>
    Number six_volumes(const std::array<NodeIndex, 4> &cell, const NodalVectors<Number> &X)
    {
      const Vector3<Number> &x = X[cell[0]];
      return cross(Vector3<Number>(X[cell[1]] - x), Vector3<Number>(X[cell[2]] - x)) * (X[cell[3]] - x);
    }

    // Twice its area, outward [mm^2].
    template <typename Number>
    Vector3<Number> normal_of(const BoundaryFace &face, const NodalVectors<Number> &X)
    {
      const Vector3<Number> &x = X[face.nodes[0]];
      return cross(Vector3<Number>(X[face.nodes[1]] - x), Vector3<Number>(X[face.nodes[2]] - x));
    }

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

  template <typename Number>
  RecoveredGradient<Number>::RecoveredGradient(const TetMesh &mesh, const NodalVectors<Number> &X)
      : mesh_(mesh)
      , X_(X)
      , cells_at_(items_at_nodes(mesh.cells, mesh.n_nodes()))
      , faces_at_(items_at_nodes(mesh.faces, mesh.n_nodes()))
  {
  }

  template <typename Number>
  Vector3<Number> RecoveredGradient<Number>::Stencil::components(const Vector3<Number> &v) const
  {
    Vector3<Number> c;
    for (std::size_t i = 0; i < directions.size(); ++i)
      c[i] = v * directions[i];
    return c;
  }

  template <typename Number>
  bool RecoveredGradient<Number>::stencil_inside(const NodeIndex a, Stencil &stencil) const
  {
    for (const CellIndex c : cells_at_[a])
      if (!(value_of(six_volumes(mesh_.cells[c], X_)) > 0))
        return false;
    stencil.nodes = neighbourhood(a, enough_inside, [&](const NodeIndex b, std::vector<NodeIndex> &nodes) {
      for (const CellIndex c : cells_at_[b])
        nodes.insert(nodes.end(), mesh_.cells[c].begin(), mesh_.cells[c].end());
    });
    stencil.directions.resize(3);
    for (unsigned int i = 0; i < 3; ++i)
      stencil.directions[i][i] = Number(1.);
    return true;
  }

  template <typename Number>
  bool RecoveredGradient<Number>::stencil_on_patch(const NodeIndex    a,
                                                   const unsigned int patch,
                                                   Stencil           &stencil) const
  {
    stencil.nodes = neighbourhood(a, enough_on_patch, [&](const NodeIndex b, std::vector<NodeIndex> &nodes) {
      for (const unsigned int f : faces_at_[b])
        if (const BoundaryFace &face = mesh_.faces[f]; face.patch == patch)
        {
          nodes.insert(nodes.end(), face.nodes.begin(), face.nodes.end());
          stencil.faces.push_back(f);
          stencil.across += normal_of(face, X_);
        }
    });
    const Number size = length(stencil.across);
    for (const unsigned int f : stencil.faces)
    {
      const Vector3<Number> normal = normal_of(mesh_.faces[f], X_);
      if (!(value_of(Number(normal * stencil.across)) >
            sharp_cosine * value_of(length(normal)) * value_of(size)))
        return false;
    }
    const auto across  = directions_across(Vector3<Number>(stencil.across / size));
    stencil.directions = {across[0], across[1]};
    return true;
  }

  template <typename Number>
  bool RecoveredGradient<Number>::stencil_on_ridge(const NodeIndex a,
                                                   const PatchSet &patches,
                                                   Stencil        &stencil) const
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
    stencil.first = stencil.last = stencil.nodes[0];
    Vector3<Number> chord;
    for (const NodeIndex b : stencil.nodes)
      if (const Vector3<Number> d = X_[b] - X_[stencil.first];
          value_of(Number(d * d)) > value_of(Number(chord * chord)))
      {
        chord        = d;
        stencil.last = b;
      }
    stencil.directions = {chord / length(chord)};
    return true;
  }

  template <typename Number>
  const typename RecoveredGradient<Number>::Stencil &
  RecoveredGradient<Number>::stencil_at(const NodeIndex a, const PatchSet &patches)
  {
    if (const auto found = stencils_.find({a, patches}); found != stencils_.end())
      return found->second;
    if (stencils_.size() >= most_stencils)
      stencils_.clear();
    Stencil &stencil = stencils_[{a, patches}];
    if (patches.empty()       ? stencil_inside(a, stencil)
        : patches.size() == 1 ? stencil_on_patch(a, patches[0], stencil)
                              : stencil_on_ridge(a, patches, stencil))
    {
      std::vector<Vector3<Number>> points;
      for (const NodeIndex b : stencil.nodes)
        points.push_back(stencil.components(X_[b] - X_[a]));
      stencil.fit.emplace(points, stencil.directions.size());
      if (!stencil.fit->is_determined())
        stencil.fit.reset();
    }
    return stencil;
  }

  template <typename Number>
  bool RecoveredGradient<Number>::add_directional(const NodeIndex        a,
                                                  const PatchSet        &patches,
                                                  const Vector3<Number> &direction,
                                                  Row                   &row)
  {
    const Stencil &stencil = stencil_at(a, patches);
    if (!stencil.fit)
      return false;
    const auto coefficients = stencil.fit->coefficients(stencil.components(direction));
    for (std::size_t b = 0; b < stencil.nodes.size(); ++b)
    {
      row.emplace_back(stencil.nodes[b], coefficients[b]);
      row.emplace_back(a, -coefficients[b]);
    }
    return true;
  }

  template <>
  void RecoveredGradient<double>::reverse_coefficients(const NodeIndex            a,
                                                       const Stencil             &stencil,
                                                       const Vec3                &direction,
                                                       const std::vector<double> &c_bar,
                                                       NodalVectors<double>      &X_bar,
                                                       Vec3                      &direction_bar) const
  {
    std::vector<Vec3> points_bar(stencil.nodes.size()), along_bar(stencil.directions.size());
    Vec3              components_bar;
    stencil.fit->reverse(stencil.components(direction), c_bar, points_bar, components_bar);
    const auto reverse_components = [&](const Vec3 &v, const Vec3 &bar) {
      Vec3 v_bar;
      for (std::size_t i = 0; i < along_bar.size(); ++i)
      {
        v_bar += bar[i] * stencil.directions[i];
        along_bar[i] += bar[i] * v;
      }
      return v_bar;
    };
    direction_bar += reverse_components(direction, components_bar);
    for (std::size_t b = 0; b < stencil.nodes.size(); ++b)
    {
      const NodeIndex node = stencil.nodes[b];
      const Vec3      bar  = reverse_components(X_[node] - X_[a], points_bar[b]);
      X_bar[node] += bar;
      X_bar[a] -= bar;
    }
    if (along_bar.size() == 2)
    {
      const Vec3 across_bar = reverse_unit(
        stencil.across,
        reverse_directions_across(stencil.across / stencil.across.norm(), {{along_bar[0], along_bar[1]}}));
      for (const unsigned int f : stencil.faces)
      {
        const auto &[x, y, z] = mesh_.faces[f].nodes;
        const Vec3 y_bar = cross(X_[z] - X_[x], across_bar), z_bar = cross(across_bar, X_[y] - X_[x]);
        X_bar[y] += y_bar;
        X_bar[z] += z_bar;
        X_bar[x] -= y_bar + z_bar;
      }
    }
    else if (along_bar.size() == 1)
    {
      const Vec3 bar = reverse_unit(X_[stencil.last] - X_[stencil.first], along_bar[0]);
      X_bar[stencil.last] += bar;
      X_bar[stencil.first] -= bar;
    }
  }

  template class RecoveredGradient<double>;
  template class RecoveredGradient<Dual>;
} // namespace retroforge
