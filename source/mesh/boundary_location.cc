// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/boundary_location.h>

#include <algorithm>
#include <limits>
#include <tuple>

namespace retroforge
{
  namespace
  {
    bool contains(const PatchSet &larger, const PatchSet &smaller)
    {
      return std::includes(larger.begin(), larger.end(), smaller.begin(), smaller.end());
    }

    struct BoundaryEdge
    {
      NodeIndex    a, b;
      unsigned int patch;
    };

    // The edges of all boundary faces, with lower node first, so that the two faces of an edge stand side by
    // side.
    std::vector<BoundaryEdge> sorted_edges(const TetMesh &mesh)
    {
      std::vector<BoundaryEdge> edges;
      for (const auto &face : mesh.faces)
        for (unsigned int i = 0; i < 3; ++i)
        {
          const auto [a, b] = std::minmax({face.nodes[i], face.nodes[(i + 1) % 3]});
          edges.push_back({a, b, face.patch});
        }
      std::sort(edges.begin(), edges.end(), [](const BoundaryEdge &e, const BoundaryEdge &f) {
        return std::tie(e.a, e.b, e.patch) < std::tie(f.a, f.b, f.patch);
      });
      return edges;
    }
  } // namespace

  std::vector<PatchSet> patches_at_nodes(const TetMesh &mesh)
  {
    std::vector<PatchSet> patches(mesh.n_nodes());
    for (const auto &face : mesh.faces)
      for (const NodeIndex node : face.nodes)
      {
        auto      &at    = patches[node];
        const auto place = std::lower_bound(at.begin(), at.end(), face.patch);
        if (place == at.end() || *place != face.patch)
          at.insert(place, face.patch);
      }
    return patches;
  }

  BoundaryLocator::BoundaryLocator(const TetMesh &mesh, const NodalVectors<double> &X) : X_(X)
  {
    std::vector<Feature> nodes, edges, faces;
    const auto           at_nodes = patches_at_nodes(mesh);
    for (NodeIndex node = 0; node < mesh.n_nodes(); ++node)
      if (at_nodes[node].size() > 2)
        nodes.push_back({at_nodes[node], {{node, node, node}}});
    const auto sorted = sorted_edges(mesh);
    for (std::size_t i = 1; i < sorted.size(); ++i)
    {
      const BoundaryEdge &e = sorted[i - 1], &f = sorted[i];
      if (e.a == f.a && e.b == f.b && e.patch != f.patch)
        edges.push_back({{e.patch, f.patch}, {{e.a, e.b, e.b}}});
    }
    for (const auto &face : mesh.faces)
      faces.push_back({{face.patch}, face.nodes});
    add_groups(std::move(nodes), 1);
    add_groups(std::move(edges), 2);
    add_groups(std::move(faces), 3);
  }

  void BoundaryLocator::add_groups(std::vector<Feature> features, const unsigned int n_corners)
  {
    std::stable_sort(features.begin(), features.end(), [](const Feature &f, const Feature &g) {
      return f.patches < g.patches;
    });
    for (std::size_t first = 0, last; first < features.size(); first = last)
    {
      std::vector<std::array<NodeIndex, 3>> same;
      std::vector<BoundingBox>              boxes;
      for (last = first; last < features.size() && features[last].patches == features[first].patches; ++last)
      {
        same.push_back(features[last].nodes);
        boxes.emplace_back(X_[same.back()[0]]);
        for (const NodeIndex node : same.back())
          boxes.back().include(X_[node]);
      }
      groups_.push_back({features[first].patches, n_corners, std::move(same), BoxTree(boxes)});
    }
  }

  BoundaryPoint BoundaryLocator::point_on(const Group &group, const unsigned int feature, const Vec3 &x) const
  {
    const auto &n = group.features[feature];
    if (group.n_corners == 1)
      return {{n[0]}, {1.}, group.patches};
    if (group.n_corners == 2)
    {
      const auto w = closest_on_segment(x, {{X_[n[0]], X_[n[1]]}});
      return {{n[0], n[1]}, {w[0], w[1]}, group.patches};
    }
    const auto w = closest_on_triangle(x, {{X_[n[0]], X_[n[1]], X_[n[2]]}});
    return {{n[0], n[1], n[2]}, {w[0], w[1], w[2]}, group.patches};
  }

  double BoundaryLocator::square_distance(const BoundaryPoint &point, const Vec3 &x) const
  {
    Vec3 difference = -x;
    for (std::size_t i = 0; i < point.nodes.size(); ++i)
      difference += point.weights[i] * X_[point.nodes[i]];
    return difference.norm_square();
  }

  // Empty when no group with that many corners meets the condition on its patches.
  template <typename Condition>
  BoundaryPoint
  BoundaryLocator::closest_of(const Vec3 &x, const unsigned int n_corners, const Condition &condition) const
  {
    BoundaryPoint best;
    double        best_square = std::numeric_limits<double>::max();
    for (const Group &group : groups_)
      if (group.n_corners == n_corners && condition(group.patches))
      {
        const auto distance = [&](const unsigned int f) { return square_distance(point_on(group, f, x), x); };
        const BoundaryPoint point  = point_on(group, group.tree.closest(x, distance), x);
        const double        square = square_distance(point, x);
        if (square < best_square)
        {
          best        = point;
          best_square = square;
        }
      }
    return best;
  }

  BoundaryPoint BoundaryLocator::locate(const Vec3 &x, const PatchSet &patches) const
  {
    const auto    of_all  = [&](const PatchSet &s) { return contains(s, patches); };
    const auto    of_some = [&](const PatchSet &s) { return contains(patches, s); };
    const auto    any     = [](const PatchSet &) { return true; };
    BoundaryPoint point;
    if (patches.size() > 2)
      point = closest_of(x, 1, of_all);
    if (point.nodes.empty() && patches.size() > 1)
      point = closest_of(x, 2, of_some);
    if (point.nodes.empty())
      point = closest_of(x, 3, of_some);
    return point.nodes.empty() ? closest_of(x, 3, any) : point;
  }
} // namespace retroforge
