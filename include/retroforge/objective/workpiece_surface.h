// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/final_objective.h>

#include <memory>

namespace retroforge
{
  /// The surface of the workpiece, symmetry planes left out, as a TriangleSurface whose normals point
  /// outwards. Its connectivity, and the rounding at edges, stay as they were when it was made.
  class WorkpieceSurface
  {
  public:
    WorkpieceSurface() = default;

    /// @throws Error  when the surface is folded onto itself (see TriangleSurface)
    explicit WorkpieceSurface(const FinalView<double> &view);

    const TriangleSurface &shape() const { return *shape_; }

    /// Returns the positions of its vertices.
    template <typename Number>
    NodalVectors<Number> vertices(const FinalView<Number> &view) const
    {
      NodalVectors<Number> x;
      for (const NodeIndex k : nodes_)
        x.push_back(view.X[k]);
      return x;
    }

    /// Returns the shape with its vertices at the positions of a view.
    TriangleSurface moved(const FinalView<double> &view) const;

    /// Adds derivatives in its vertices to those in the nodes.
    void add(const NodalVectors<double> &vertices_bar, FinalBar &bar) const;

  private:
    std::vector<NodeIndex>                 nodes_; ///< node of each vertex
    std::shared_ptr<const TriangleSurface> shape_;
  };
} // namespace retroforge
