// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/boundary_location.h>
#include <retroforge/mesh/topology.h>

#include <utility>
#include <vector>

namespace retroforge
{
  /// Gradients at nodes of a field of nodal values, from the cubic that fits the values around (see
  /// fitted_derivative()): linear in the values, and exact for linear fields. On a patch they are tangential
  /// and look at nodes of the patch only, on a ridge they are along it.
  class RecoveredGradient
  {
  public:
    /// Coefficients of nodal values.
    using Row = std::vector<std::pair<NodeIndex, double>>;

    /// Keeps references to both arguments.
    RecoveredGradient(const TetMesh &mesh, const NodalVectors<double> &X);

    /// Appends the coefficients of  direction·G_a, G_a the gradient at node a, to a row.
    /// @param patches    none: of all nodes; one: of those of the patch; two: of those of their ridge
    /// @param direction  of a patch, only its part along the patch counts, likewise of a ridge
    /// @return whether there is a gradient to rely on: there is none beside inverted cells, where a patch has
    /// a sharp edge, and where too few nodes are around
    bool add_directional(NodeIndex a, const PatchSet &patches, const Vec3 &direction, Row &row) const;

  private:
    /// Nodes around another one, and the orthonormal directions in which the gradient is wanted.
    struct Stencil
    {
      std::vector<NodeIndex> nodes;
      std::vector<Vec3>      directions;
    };

    bool stencil_inside(NodeIndex a, Stencil &stencil) const;
    bool stencil_on_patch(NodeIndex a, unsigned int patch, Stencil &stencil) const;
    bool stencil_on_ridge(NodeIndex a, const PatchSet &patches, Stencil &stencil) const;

    const TetMesh              &mesh_;
    const NodalVectors<double> &X_;
    Rows<unsigned int>          cells_at_, faces_at_;
  };
} // namespace retroforge
