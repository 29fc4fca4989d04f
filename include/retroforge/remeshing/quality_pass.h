// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/cell_faces.h>
#include <retroforge/remeshing/remeshing_context.h>
#include <retroforge/remeshing/remeshing_report.h>

#include <array>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace retroforge
{
  /// Improves bad cells, the worst first, until none can be improved.
  ///
  /// A cell below the swap angle gets the best of its six edge removals and four face flips. Only below the
  /// goal angle, when no swap helps, a node is moved, then one collapsed, then one inserted: those change
  /// values at nodes. Every operation raises the smallest quality of the cells it changes, so that the pass
  /// ends. What did not help, a cell, a move of a node, a split of an edge, is not tried again until
  /// something it depends on changes.
  class QualityPass
  {
  public:
    QualityPass(RemeshingContext &context, RemeshingReport &report);

    void run();

  private:
    bool                        sweep();
    bool                        improve(CellIndex cell);
    bool                        swap(CellIndex cell);
    bool                        smooth(CellIndex cell);
    bool                        collapse(CellIndex cell);
    bool                        split(CellIndex cell);
    void                        apply(const CavityChange &change);
    bool                        has_changed(const std::vector<NodeIndex> &nodes, CellIndex since) const;
    std::optional<CavityChange> smoothed(NodeIndex node);
    std::optional<CavityChange> halved(NodeIndex a, NodeIndex b);

    RemeshingContext &context_;
    RemeshingReport  &report_;
    const double      swap_quality_;
    const double      trigger_quality_;
    const double      goal_quality_;
    // Number of cells there were when nothing helped a cell, when a node could not be moved for the better,
    // nor an edge be split.
    std::vector<CellIndex>                 cell_failed_at_, node_failed_at_;
    std::map<EdgeKey, CellIndex>           edge_failed_at_;
    std::set<std::pair<double, CellIndex>> queue_;
  };
} // namespace retroforge
