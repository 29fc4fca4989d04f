// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/topology.h>

namespace retroforge
{
  /// A place of the workpiece's surface where contact is looked for: a node, or the middle of an edge. Its
  /// position and velocity are the mean of its nodes', and what acts on it acts on them in equal parts.
  struct ContactPoint
  {
    std::array<NodeIndex, 2> nodes; ///< the second one is invalid_index for a node

    static ContactPoint node(const NodeIndex k) { return {{{k, invalid_index}}}; }
    static ContactPoint middle(const NodeIndex a, const NodeIndex b) { return {{{a, b}}}; }

    bool         is_node() const { return nodes[1] == invalid_index; }
    unsigned int n_nodes() const { return is_node() ? 1 : 2; }
    /// The part of each node.
    double weight() const { return is_node() ? 1. : 0.5; }

    bool operator==(const ContactPoint &other) const { return nodes == other.nodes; }

    /// Position or velocity of the point from those of all nodes.
    template <typename Number>
    Vector3<Number> mean(const NodalVectors<Number> &x) const
    {
      return is_node() ? x[nodes[0]] : Vector3<Number>((x[nodes[0]] + x[nodes[1]]) * Number(0.5));
    }

    /// Adds to its nodes what acts on the point: the transpose of mean().
    template <typename Number>
    void add(const Vector3<Number> &at_point, NodalVectors<Number> &x) const
    {
      if (is_node())
        x[nodes[0]] += at_point;
      else
        for (const NodeIndex k : nodes)
          x[k] += at_point * Number(0.5);
    }

    /// The surface faces all its nodes are of, as TetMesh::faces numbers them: `use(face)` for each.
    template <typename Use>
    void for_each_face(const TetMesh &mesh, const Topology &topology, const Use &use) const
    {
      for (const unsigned int f : topology.surface_faces[nodes[0]])
        if (const auto &corners = mesh.faces[f].nodes;
            is_node() || corners[0] == nodes[1] || corners[1] == nodes[1] || corners[2] == nodes[1])
          use(f);
    }
  };
} // namespace retroforge
