// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/boundary_location.h>
#include <retroforge/mesh/topology.h>
#include <retroforge/transfer/gradient_fit.h>

#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace retroforge
{
  /// Gradients at nodes of a field of nodal values, from the cubic that fits the values around (GradientFit): linear in the
  /// values, and exact for linear fields. On a patch they are tangential and look at nodes of the patch only, on a ridge they
  /// are along it.
  template <typename Number>
  class RecoveredGradient
  {
  public:
    /// Coefficients of nodal values.
    using Row = std::vector<std::pair<NodeIndex, Number>>;

    /// Keeps references to both arguments.
    RecoveredGradient(const TetMesh &mesh, const NodalVectors<Number> &X);

    /// Returns whether there is a gradient to rely on: there is none beside inverted cells, where a patch has
    /// a sharp edge, and where too few nodes are around.
    /// @param patches    none: of all nodes; one: of those of the patch; two: of those of their ridge
    bool has(NodeIndex a, const PatchSet &patches) { return stencil_at(a, patches).fit.has_value(); }

    /// Appends the coefficients of  direction·G_a, G_a the gradient at node a, to a row.
    /// @param direction  of a patch, only its part along the patch counts, likewise of a ridge
    /// @return whether there is a gradient
    bool add_directional(NodeIndex a, const PatchSet &patches, const Vector3<Number> &direction, Row &row);

    /// Adds the pull-back of add_directional(), where there is a gradient, to X_bar and direction_bar; on double.
    /// @param bar  returns the derivative in the coefficient of a node
    template <typename Bar>
    void reverse(NodeIndex             a,
                 const PatchSet       &patches,
                 const Vec3           &direction,
                 const Bar            &bar,
                 NodalVectors<double> &X_bar,
                 Vec3                 &direction_bar)
    {
      const Stencil      &stencil = stencil_at(a, patches);
      std::vector<double> c_bar;
      for (const NodeIndex b : stencil.nodes)
        c_bar.push_back(bar(b) - bar(a));
      reverse_coefficients(a, stencil, direction, c_bar, X_bar, direction_bar);
    }

  private:
    /// Nodes around another one, the orthonormal directions in which the gradient is wanted, and what these follow from.
    struct Stencil
    {
      std::vector<NodeIndex>             nodes;
      std::vector<Vector3<Number>>       directions;
      std::vector<unsigned int>          faces;  ///< of a patch: the sum of their normals is `across`
      Vector3<Number>                    across; ///< [mm^2]
      NodeIndex                          first = 0, last = 0; ///< of a ridge: the ends of its chord
      std::optional<GradientFit<Number>> fit;                 ///< none where there is no gradient

      /// Along the directions.
      Vector3<Number> components(const Vector3<Number> &v) const;
    };

    bool           stencil_inside(NodeIndex a, Stencil &stencil) const;
    bool           stencil_on_patch(NodeIndex a, unsigned int patch, Stencil &stencil) const;
    bool           stencil_on_ridge(NodeIndex a, const PatchSet &patches, Stencil &stencil) const;
    const Stencil &stencil_at(NodeIndex a, const PatchSet &patches);
    void           reverse_coefficients(NodeIndex                  a,
                                        const Stencil             &stencil,
                                        const Vec3                &direction,
                                        const std::vector<double> &c_bar,
                                        NodalVectors<double>      &X_bar,
                                        Vec3                      &direction_bar) const;

    const TetMesh                                    &mesh_;
    const NodalVectors<Number>                       &X_;
    Rows<unsigned int>                                cells_at_, faces_at_;
    std::map<std::pair<NodeIndex, PatchSet>, Stencil> stencils_; ///< those that were used last
  };

  template <>
  void RecoveredGradient<double>::reverse_coefficients(NodeIndex                  a,
                                                       const Stencil             &stencil,
                                                       const Vec3                &direction,
                                                       const std::vector<double> &c_bar,
                                                       NodalVectors<double>      &X_bar,
                                                       Vec3                      &direction_bar) const;
} // namespace retroforge
