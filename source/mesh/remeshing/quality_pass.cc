// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/remeshing/collapse.h>
#include <retroforge/mesh/remeshing/edge_removal.h>
#include <retroforge/mesh/remeshing/face_flip.h>
#include <retroforge/mesh/remeshing/quality_pass.h>
#include <retroforge/mesh/remeshing/smoothing.h>
#include <retroforge/mesh/remeshing/split.h>

#include <cmath>

namespace retroforge
{
  namespace
  {
    // Less is not worth a change.
    constexpr double least_gain = 1e-3;
    // New edges must leave the length pass content, with a margin.
    constexpr double shortest_half = 0.4;

    constexpr unsigned int edges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

    double quality_of_angle(const double degrees)
    {
      return std::sin(degrees * M_PI / 180);
    }

    void keep_better(std::optional<CavityChange> &best, std::optional<CavityChange> &&other)
    {
      if (other && (!best || other->gain() > best->gain()))
        best = std::move(other);
    }
  } // namespace

  QualityPass::QualityPass(RemeshingContext &context, RemeshingReport &report)
      : context_(context)
      , report_(report)
      , swap_quality_(quality_of_angle(context.parameters.swap_angle))
      , goal_quality_(quality_of_angle(context.parameters.goal_angle))
  {
  }

  void QualityPass::run()
  {
    for (unsigned int i = 0; i < context_.parameters.max_sweeps; ++i)
      if (!sweep())
        break;
    for (CellIndex cell = 0; cell < context_.mesh.n_cells(); ++cell)
      if (context_.mesh.is_alive(cell) && context_.mesh.quality(cell) < goal_quality_)
        ++report_.n_cells_left_bad;
  }

  bool QualityPass::may_improve(const CellIndex cell) const
  {
    if (failed_at_[cell] == invalid_index)
      return true;
    for (const NodeIndex node : context_.mesh.cell(cell))
      if (context_.mesh.last_change(node) > failed_at_[cell])
        return true;
    return false;
  }

  bool QualityPass::sweep()
  {
    const EditableMesh &mesh = context_.mesh;
    failed_at_.resize(mesh.n_cells(), invalid_index);
    for (CellIndex cell = 0; cell < mesh.n_cells(); ++cell)
      if (mesh.is_alive(cell) && mesh.quality(cell) < swap_quality_ && may_improve(cell))
        queue_.insert({mesh.quality(cell), cell});
    bool is_changed = false;
    while (!queue_.empty())
    {
      const CellIndex cell = queue_.begin()->second;
      queue_.erase(queue_.begin());
      if (!mesh.is_alive(cell))
        continue;
      if (improve(cell))
        is_changed = true;
      else
        failed_at_[cell] = mesh.n_cells();
    }
    return is_changed;
  }

  bool QualityPass::improve(const CellIndex cell)
  {
    if (swap(cell))
      return true;
    return context_.mesh.quality(cell) < goal_quality_ && (smooth(cell) || collapse(cell) || split(cell));
  }

  void QualityPass::apply(const CavityChange &change)
  {
    EditableMesh   &mesh  = context_.mesh;
    const CellIndex first = mesh.n_cells();
    mesh.apply(change);
    failed_at_.resize(mesh.n_cells(), invalid_index);
    for (CellIndex cell = first; cell < mesh.n_cells(); ++cell)
      if (mesh.quality(cell) < swap_quality_)
        queue_.insert({mesh.quality(cell), cell});
  }

  bool QualityPass::swap(const CellIndex cell)
  {
    const Cell                  nodes = context_.mesh.cell(cell);
    std::optional<CavityChange> best, flip;
    for (const auto &[i, j] : edges)
      keep_better(best, plan_edge_removal(context_, nodes[i], nodes[j], least_gain));
    for (unsigned int corner = 0; corner < 4; ++corner)
      keep_better(flip, plan_face_flip(context_, cell, corner, least_gain));
    if (flip && (!best || flip->gain() > best->gain()))
    {
      apply(*flip);
      ++report_.n_face_flips;
      return true;
    }
    if (!best)
      return false;
    apply(*best);
    ++(best->removed_faces.empty() ? report_.n_edge_removals : report_.n_surface_flips);
    return true;
  }

  bool QualityPass::smooth(const CellIndex cell)
  {
    std::optional<CavityChange> best;
    for (const NodeIndex node : context_.mesh.cell(cell))
      keep_better(best, plan_smoothing(context_, node, least_gain));
    if (!best)
      return false;
    apply(*best);
    ++report_.n_smoothings;
    return true;
  }

  bool QualityPass::collapse(const CellIndex cell)
  {
    const Cell                  nodes = context_.mesh.cell(cell);
    std::optional<CavityChange> best;
    for (const NodeIndex from : nodes)
    {
      const double bound = minimum_quality(context_.mesh, context_.mesh.cells_at(from)) + least_gain;
      for (const NodeIndex to : nodes)
        if (to != from)
          keep_better(best, plan_collapse(context_, from, to, bound, context_.parameters.longest_edge));
    }
    if (!best)
      return false;
    apply(*best);
    ++report_.n_quality_collapses;
    return true;
  }

  bool QualityPass::split(const CellIndex cell)
  {
    const Cell                  nodes = context_.mesh.cell(cell);
    std::optional<CavityChange> best;
    for (const auto &[i, j] : edges)
      if (context_.relative_length(nodes[i], nodes[j]) > 2 * shortest_half)
      {
        const auto   cells = context_.mesh.cells_at_edge(nodes[i], nodes[j]);
        const double bound = minimum_quality(context_.mesh, cells) + least_gain;
        keep_better(best, plan_split(context_, nodes[i], nodes[j], bound, true));
      }
    if (!best)
      return false;
    apply(*best);
    ++report_.n_quality_splits;
    return true;
  }
} // namespace retroforge
