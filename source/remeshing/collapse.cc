// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/remeshing/collapse.h>
#include <retroforge/remeshing/edge_removal.h>

#include <algorithm>
#include <iterator>
#include <limits>

namespace retroforge
{
  namespace
  {
    using Edge = std::array<NodeIndex, 2>;

    template <typename T>
    void sort_unique(std::vector<T> &list)
    {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    }

    template <typename T>
    std::vector<T> common(const std::vector<T> &a, const std::vector<T> &b)
    {
      std::vector<T> both;
      std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
      return both;
    }

    // Whether two ridges run from neighbour to neighbour of a, one over a, one over b, with nothing but two
    // faces between: the side of the workpiece that rolls onto a die leaves such a slit, and cells over it
    // that become ever flatter. It closes when a goes to b.
    bool closes_slit(const EditableMesh &mesh, const NodeIndex a, const NodeIndex b)
    {
      const auto between = mesh.faces_at_edge(a, b);
      const auto ridges  = mesh.ridges_at(a);
      return ridges.size() == 2 && between.size() == 2 &&
             std::all_of(ridges.begin(), ridges.end(), [&](const Ridge &ridge) {
               const NodeIndex c = ridge.nodes[0] == a ? ridge.nodes[1] : ridge.nodes[0];
               return mesh.curve_of_edge(b, c) != invalid_index &&
                      std::any_of(between.begin(), between.end(), [&](const unsigned int f) {
                        return contains(mesh.face(f).nodes, c);
                      });
             });
    }

    bool edge_carries_features(const EditableMesh &mesh, const NodeIndex a, const NodeIndex b)
    {
      switch (mesh.kind(a))
      {
        case NodeKind::interior:
          return true;
        case NodeKind::surface:
          return mesh.faces_at_edge(a, b).size() == 2 && mesh.curve_of_edge(a, b) == invalid_index;
        case NodeKind::ridge:
          return mesh.curve_of_edge(a, b) != invalid_index ? mesh.ridges_at(a).size() == 2
                                                           : closes_slit(mesh, a, b);
        default:
          return false;
      }
    }

    // Edges of the link of a node between the given nodes, ascending.
    std::vector<Edge>
    link_edges(const EditableMesh &mesh, const NodeIndex node, const std::vector<NodeIndex> &among)
    {
      std::vector<Edge> edges;
      for (const CellIndex c : mesh.cells_at(node))
      {
        std::vector<NodeIndex> corners;
        for (const NodeIndex other : mesh.cell(c))
          if (other != node && std::binary_search(among.begin(), among.end(), other))
            corners.push_back(other);
        std::sort(corners.begin(), corners.end());
        for (std::size_t i = 0; i < corners.size(); ++i)
          for (std::size_t j = i + 1; j < corners.size(); ++j)
            edges.push_back({{corners[i], corners[j]}});
      }
      sort_unique(edges);
      return edges;
    }

    std::vector<NodeIndex> boundary_neighbours(const EditableMesh &mesh, const NodeIndex node)
    {
      std::vector<NodeIndex> found;
      for (const unsigned int f : mesh.faces_at(node))
        for (const NodeIndex other : mesh.face(f).nodes)
          if (other != node)
            found.push_back(other);
      sort_unique(found);
      return found;
    }

    bool links_meet_at_edge_only(const EditableMesh &mesh, const NodeIndex a, const NodeIndex b)
    {
      const EdgeRing ring       = edge_ring(mesh, a, b);
      auto           ring_nodes = ring.nodes;
      std::sort(ring_nodes.begin(), ring_nodes.end());
      if (common(mesh.neighbours(a), mesh.neighbours(b)) != ring_nodes)
        return false;
      std::size_t n_edges = ring.cells.size();
      if (common(link_edges(mesh, a, ring_nodes), link_edges(mesh, b, ring_nodes)).size() != n_edges)
        return false;
      // Edges from the outside to a node: the node is on the boundary with both a and b.
      const auto both = common(boundary_neighbours(mesh, a), boundary_neighbours(mesh, b));
      return both.size() == mesh.faces_at_edge(a, b).size();
    }

    void plan_faces(const EditableMesh &mesh, const NodeIndex a, const NodeIndex b, CavityChange &change)
    {
      change.removed_faces = mesh.faces_at(a);
      for (const unsigned int f : change.removed_faces)
        if (!contains(mesh.face(f).nodes, b))
          change.added_faces.push_back({replaced(mesh.face(f).nodes, a, b), mesh.face(f).region});
    }

    // False when the curve would become a single edge and back.
    bool plan_ridges(const EditableMesh &mesh, const NodeIndex a, const NodeIndex b, CavityChange &change)
    {
      change.removed_ridges = mesh.ridges_at(a);
      if (mesh.curve_of_edge(a, b) == invalid_index)
        return true; // b's own ridge takes the place of a slit's other one
      for (const Ridge &ridge : change.removed_ridges)
        if (!contains(ridge.nodes, b))
        {
          const NodeIndex c = ridge.nodes[0] == a ? ridge.nodes[1] : ridge.nodes[0];
          if (mesh.curve_of_edge(b, c) != invalid_index)
            return false;
          change.added_ridges.push_back({{{b, c}}, ridge.curve});
        }
      return true;
    }

    bool keeps_shape(const RemeshingContext &context,
                     const NodeIndex         a,
                     const NodeIndex         b,
                     const CavityChange     &change)
    {
      if (change.added_faces.empty())
        return true;
      const EditableMesh &mesh     = context.mesh;
      const double        h        = context.size(mesh.X(a));
      double              distance = std::numeric_limits<double>::max();
      for (const SurfaceFace &face : change.added_faces)
      {
        const auto after = corners(face.nodes, mesh);
        if (!look_alike(corners(replaced(face.nodes, b, a), mesh), after))
          return false;
        distance = std::min(distance, (nearest_on_triangle(mesh.X(a), after).point - mesh.X(a)).norm());
      }
      if (distance > context.parameters.surface_deviation * h)
        return false;
      for (const Ridge &ridge : change.added_ridges)
      {
        const Vec3  &p = mesh.X(ridge.nodes[0]), &q = mesh.X(ridge.nodes[1]);
        const double t = nearest_on_segment(mesh.X(a), p, q);
        if (((1 - t) * p + t * q - mesh.X(a)).norm() > context.parameters.ridge_deviation * h)
          return false;
      }
      return true;
    }

    bool edges_short_enough(const RemeshingContext &context,
                            const NodeIndex         a,
                            const NodeIndex         b,
                            const double            longest)
    {
      for (const NodeIndex other : context.mesh.neighbours(a))
        if (other != b && context.is_longer(other, b, longest))
          return false;
      return true;
    }
  } // namespace

  std::optional<CavityChange> plan_collapse(const RemeshingContext &context,
                                            const NodeIndex         a,
                                            const NodeIndex         b,
                                            const double            bound,
                                            const double            longest)
  {
    const EditableMesh &mesh = context.mesh;
    if (!edge_carries_features(mesh, a, b))
      return {};
    CavityChange change;
    change.removed_cells = mesh.cells_at(a);
    for (const CellIndex c : change.removed_cells)
      if (!contains(mesh.cell(c), b))
        change.added_cells.push_back(replaced(mesh.cell(c), a, b));
    if (change.added_cells.empty() || !evaluate(mesh, std::max(0., bound), change))
      return {};
    plan_faces(mesh, a, b, change);
    if (!plan_ridges(mesh, a, b, change) || !edges_short_enough(context, a, b, longest) ||
        !keeps_shape(context, a, b, change) || !links_meet_at_edge_only(mesh, a, b) ||
        hides_metal(context, change))
      return {};
    return change;
  }
} // namespace retroforge
