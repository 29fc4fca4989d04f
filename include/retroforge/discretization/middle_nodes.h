// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/types.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <array>
#include <vector>

namespace retroforge
{
  /// The nodes that quadratic functions have in the middles of edges: after those at the vertices, in the
  /// order of the edges' ends.
  class MiddleNodes
  {
  public:
    using Ends = std::array<NodeIndex, 2>; ///< the smaller one first

    MiddleNodes() = default;

    /// @param ends  of the mesh's edges, each once or more, in any order
    MiddleNodes(const unsigned int n_vertices, std::vector<Ends> ends)
        : n_vertices_(n_vertices), ends_(std::move(ends))
    {
      std::sort(ends_.begin(), ends_.end());
      ends_.erase(std::unique(ends_.begin(), ends_.end()), ends_.end());
      ends_.shrink_to_fit();
    }

    unsigned int size() const { return ends_.size(); }

    /// Ends of each edge, ascending: the middle of edge e is node n_vertices + e.
    const std::vector<Ends> &ends() const { return ends_; }

    /// The vertices whose middle node k is.
    const Ends &ends_of(const NodeIndex k) const
    {
      Assert(k >= n_vertices_ && k - n_vertices_ < ends_.size(),
             dealii::ExcIndexRange(k, n_vertices_, n_vertices_ + ends_.size()));
      return ends_[k - n_vertices_];
    }

    /// The node between two vertices, in either order; invalid_index where no edge joins them.
    NodeIndex between(const NodeIndex a, const NodeIndex b) const
    {
      const Ends edge  = {{std::min(a, b), std::max(a, b)}};
      const auto found = std::lower_bound(ends_.begin(), ends_.end(), edge);
      return found != ends_.end() && *found == edge ? n_vertices_ + (found - ends_.begin()) : invalid_index;
    }

  private:
    unsigned int      n_vertices_ = 0;
    std::vector<Ends> ends_;
  };
} // namespace retroforge
