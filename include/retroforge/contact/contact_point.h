// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/discretization/node_vector.h>
#include <retroforge/mesh/topology.h>

namespace retroforge
{
  /// A place of the workpiece's surface where contact is looked for: a node, or the middle of an edge. Its
  /// position is the mean of its nodes'. Where velocities are quadratic, the middle has one of its own; where
  /// they are linear, the mean of its nodes', and what acts on it acts on them in equal parts.
  struct ContactPoint
  {
    std::array<NodeIndex, 2> nodes;         ///< the second one is invalid_index for a node
    NodeIndex                velocity_node; ///< invalid_index: that of a middle is the mean of its nodes'

    static ContactPoint node(const NodeIndex k) { return {{{k, invalid_index}}, k}; }
    static ContactPoint
    middle(const NodeIndex a, const NodeIndex b, const NodeIndex velocity_node = invalid_index)
    {
      return {{{a, b}}, velocity_node};
    }

    bool         is_node() const { return nodes[1] == invalid_index; }
    unsigned int n_nodes() const { return is_node() ? 1 : 2; }
    /// The part of each node.
    double weight() const { return is_node() ? 1. : 0.5; }

    bool has_own_velocity() const { return velocity_node != invalid_index; }

    /// The nodes whose velocities make that of the point, all with the same weight.
    unsigned int n_velocity_nodes() const { return has_own_velocity() ? 1 : 2; }
    NodeIndex    velocity_node_at(const unsigned int i) const
    {
      return has_own_velocity() ? velocity_node : nodes[i];
    }
    double velocity_weight() const { return has_own_velocity() ? 1. : 0.5; }

    bool operator==(const ContactPoint &other) const
    {
      return nodes == other.nodes && velocity_node == other.velocity_node;
    }

    template <typename Number>
    Vector3<Number> position(const NodalVectors<Number> &X) const
    {
      return is_node() ? X[nodes[0]] : Vector3<Number>((X[nodes[0]] + X[nodes[1]]) * Number(0.5));
    }

    /// The transpose of position().
    template <typename Number>
    void add_to_position(const Vector3<Number> &at_point, NodalVectors<Number> &X) const
    {
      if (is_node())
        X[nodes[0]] += at_point;
      else
        for (const NodeIndex k : nodes)
          X[k] += at_point * Number(0.5);
    }

    /// @param V  velocities by node
    template <typename Number>
    Vector3<Number> velocity(const NodeVector<3, Number> &V) const
    {
      return has_own_velocity() ? V[velocity_node]
                                : Vector3<Number>((V[nodes[0]] + V[nodes[1]]) * Number(0.5));
    }

    /// The transpose of velocity(): what acts on the point, acts on nodes.
    template <typename Number>
    void add_to_velocity(const Vector3<Number> &at_point, NodeVector<3, Number> &V) const
    {
      if (has_own_velocity())
        V[velocity_node] += at_point;
      else
        for (const NodeIndex k : nodes)
          V[k] += at_point * Number(0.5);
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
