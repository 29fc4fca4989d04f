// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/remeshing/collapse.h>
#include <retroforge/remeshing/edge_removal.h>
#include <retroforge/remeshing/face_flip.h>
#include <retroforge/remeshing/quality_pass.h>
#include <retroforge/remeshing/smoothing.h>
#include <retroforge/remeshing/split.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    // Less is not worth a change. A moved node costs values and time, and smaller gains add up to little.
    constexpr double least_gain = 1e-3, least_gain_of_move = 0.02;
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
      , trigger_quality_(quality_of_angle(context.parameters.trigger_angle))
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

  bool QualityPass::has_changed(const std::vector<NodeIndex> &nodes, const CellIndex since) const
  {
    return since == invalid_index || std::any_of(nodes.begin(), nodes.end(), [&](const NodeIndex node) {
             return context_.mesh.last_change(node) > since;
           });
  }

  bool QualityPass::sweep()
  {
    const EditableMesh &mesh = context_.mesh;
    cell_failed_at_.resize(mesh.n_cells(), invalid_index);
    for (CellIndex cell = 0; cell < mesh.n_cells(); ++cell)
      if (mesh.is_alive(cell) && mesh.quality(cell) < swap_quality_ &&
          has_changed({mesh.cell(cell).begin(), mesh.cell(cell).end()}, cell_failed_at_[cell]))
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
        cell_failed_at_[cell] = mesh.n_cells();
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
    const EditableMesh &mesh  = context_.mesh;
    const CellIndex     first = mesh.n_cells();
    context_.apply(change);
    cell_failed_at_.resize(mesh.n_cells(), invalid_index);
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

  std::optional<CavityChange> QualityPass::smoothed(const NodeIndex node)
  {
    const EditableMesh &mesh = context_.mesh;
    node_failed_at_.resize(mesh.n_nodes(), invalid_index);
    if (!has_changed(mesh.neighbours(node), node_failed_at_[node]))
      return {};
    // Cells that would call for the next remeshing at once are worth any gain.
    const double before   = minimum_quality(mesh, mesh.cells_at(node));
    const double gain     = before < trigger_quality_
                              ? least_gain
                              : std::clamp(goal_quality_ - before, least_gain, least_gain_of_move);
    auto         change   = plan_smoothing(context_, node, gain);
    node_failed_at_[node] = change ? invalid_index : mesh.n_cells();
    return change;
  }

  std::optional<CavityChange> QualityPass::halved(const NodeIndex a, const NodeIndex b)
  {
    const EditableMesh    &mesh  = context_.mesh;
    const auto             cells = mesh.cells_at_edge(a, b);
    std::vector<NodeIndex> nodes;
    for (const CellIndex cell : cells)
      nodes.insert(nodes.end(), mesh.cell(cell).begin(), mesh.cell(cell).end());
    CellIndex &failed_at = edge_failed_at_.insert({edge_key(a, b), invalid_index}).first->second;
    if (!has_changed(nodes, failed_at))
      return {};
    auto change = plan_split(context_, a, b, minimum_quality(mesh, cells) + least_gain, SplitAt::best);
    failed_at   = change ? invalid_index : mesh.n_cells();
    return change;
  }

  bool QualityPass::smooth(const CellIndex cell)
  {
    std::optional<CavityChange> best;
    for (const NodeIndex node : context_.mesh.cell(cell))
      keep_better(best, smoothed(node));
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
      if (context_.is_longer(nodes[i], nodes[j], 2 * shortest_half))
        keep_better(best, halved(nodes[i], nodes[j]));
    if (!best)
      return false;
    apply(*best);
    ++report_.n_quality_splits;
    return true;
  }
} // namespace retroforge
