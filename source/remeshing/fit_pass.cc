// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/remeshing/collapse.h>
#include <retroforge/remeshing/fit_pass.h>
#include <retroforge/remeshing/smoothing.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    constexpr unsigned int max_rounds = 8;
    // Part of the wanted edge length that a node may be away from its place.
    constexpr double near = 1e-3;
    // What cells may be spoiled to: the quality pass repairs them.
    constexpr double lowest_quality_fitted = 0.1;

    std::optional<CavityChange> plan_move(const RemeshingContext &context,
                                          const NodeIndex         node,
                                          const Place            &place,
                                          const Vec3             &target,
                                          const double            part)
    {
      const EditableMesh &mesh     = context.mesh;
      const Vec3          position = part == 1. ? target : place.towards(target, mesh.X(node), part);
      CavityChange        change;
      change.placement = {part == 1. ? Placement::How::put : Placement::How::towards,
                          {{node, node}},
                          place.kind,
                          place.feature,
                          part,
                          {},
                          0,
                          {}};
      change.placed_node   = node;
      change.position      = position;
      change.removed_cells = mesh.cells_at(node);
      for (const CellIndex c : change.removed_cells)
        change.added_cells.push_back(mesh.cell(c));
      const double before = minimum_quality(mesh, change.removed_cells);
      if (!evaluate(mesh, std::min(0.99 * before, lowest_quality_fitted), change))
        return {};
      return change;
    }

    // Whether the node has arrived.
    bool approach(RemeshingContext &context, const NodeIndex node)
    {
      const EditableMesh &mesh   = context.mesh;
      const Place         place  = place_of_node(context, node);
      const Vec3          x      = mesh.X(node);
      const Vec3          target = place(x);
      if ((target - x).norm() <= near * context.size(x))
        return true;
      for (const double part : {1., 0.5, 0.25, 0.125})
        if (const auto change = plan_move(context, node, place, target, part))
        {
          context.apply(*change);
          return part == 1.;
        }
      return false;
    }

    void move_neighbours(RemeshingContext &context, const NodeIndex node)
    {
      for (const NodeIndex other : context.mesh.neighbours(node))
        if (const auto change = plan_smoothing(context, other, 1e-3))
          context.apply(*change);
    }

    // Takes away the node inside that is next to where this one belongs.
    void remove_neighbour(RemeshingContext &context, const NodeIndex node)
    {
      const EditableMesh &mesh    = context.mesh;
      const Vec3          target  = place_of_node(context, node)(mesh.X(node));
      NodeIndex           closest = invalid_index;
      for (const NodeIndex other : mesh.neighbours(node))
        if (mesh.kind(other) == NodeKind::interior &&
            (closest == invalid_index || (mesh.X(other) - target).norm() < (mesh.X(closest) - target).norm()))
          closest = other;
      if (closest == invalid_index)
        return;
      const double bound = std::min(minimum_quality(mesh, mesh.cells_at(closest)), lowest_quality_fitted);
      std::optional<CavityChange> best;
      for (const NodeIndex to : mesh.neighbours(closest))
      {
        auto change = plan_collapse(context, closest, to, bound, context.parameters.longest_edge);
        if (change && (!best || change->quality_after > best->quality_after))
          best = std::move(change);
      }
      if (best)
        context.apply(*best);
    }
  } // namespace

  std::vector<NodeIndex> fit_pass(RemeshingContext &context, const NodeIndex first)
  {
    std::vector<NodeIndex> waiting;
    for (NodeIndex node = first; node < context.mesh.n_nodes(); ++node)
      if (context.mesh.is_used(node) && context.mesh.kind(node) != NodeKind::interior)
        waiting.push_back(node);
    for (unsigned int round = 0; round < max_rounds && !waiting.empty(); ++round)
    {
      waiting.erase(std::remove_if(waiting.begin(),
                                   waiting.end(),
                                   [&](const NodeIndex node) { return approach(context, node); }),
                    waiting.end());
      for (const NodeIndex node : waiting)
      {
        if (round % 4 == 3)
          remove_neighbour(context, node);
        move_neighbours(context, node);
      }
    }
    return waiting;
  }
} // namespace retroforge
