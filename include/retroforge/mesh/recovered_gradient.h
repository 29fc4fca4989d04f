// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/topology.h>

#include <utility>
#include <vector>

namespace retroforge
{
  /// Gradients at nodes of a piecewise linear field, as the mean over the cells at the node weighted by
  /// volume,  G_a = sum_T |T| grad q_T / sum_T |T|:  linear in the nodal values, exact for linear fields.
  class RecoveredGradient
  {
  public:
    /// Keeps references to both arguments.
    RecoveredGradient(const TetMesh &mesh, const NodalVectors<double> &X);

    /// Whether all cells at node a have a positive volume; without, there is no gradient to rely on.
    bool exists(NodeIndex a) const;

    /// Appends the coefficients of  direction·G_a  as (node, coefficient) pairs, four per cell at node a.
    /// The gradient must exist.
    void add_directional(NodeIndex                                  a,
                         const Vec3                                &direction,
                         std::vector<std::pair<NodeIndex, double>> &coefficients) const;

  private:
    const TetMesh              &mesh_;
    const NodalVectors<double> &X_;
    Topology                    topology_;
  };
} // namespace retroforge
