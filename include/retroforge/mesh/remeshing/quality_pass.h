// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/remeshing/remeshing_context.h>
#include <retroforge/mesh/remeshing/remeshing_report.h>

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
  /// ends. A cell for which nothing helped is left until something in the stars of its nodes changes.
  class QualityPass
  {
  public:
    QualityPass(RemeshingContext &context, RemeshingReport &report);

    void run();

  private:
    bool sweep();
    bool improve(CellIndex cell);
    bool swap(CellIndex cell);
    bool smooth(CellIndex cell);
    bool collapse(CellIndex cell);
    bool split(CellIndex cell);
    void apply(const CavityChange &change);
    bool may_improve(CellIndex cell) const;

    RemeshingContext                      &context_;
    RemeshingReport                       &report_;
    const double                           swap_quality_;
    const double                           goal_quality_;
    std::vector<CellIndex>                 failed_at_; ///< number of cells there were when a cell failed
    std::set<std::pair<double, CellIndex>> queue_;
  };
} // namespace retroforge
