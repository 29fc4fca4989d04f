// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/tet_mesh.h>

#include <deal.II/lac/sparse_direct.h>

#include <memory>

namespace retroforge
{
  /// P, the part of a motion d of a mesh's nodes that changes its shape. A linear map, of the mesh where it was made:
  /// - on the surface what goes across it, at sharp edges in the plane across them, all at corners. How many directions that
  ///   are tell the eigenvalues of  sum_f A_f n_f n_f^T  over the faces around. The volume changes as by d.
  /// - inside the mean of the neighbours', and on a plane of symmetry that of the neighbours on it.
  class ShapeMotion
  {
  public:
    explicit ShapeMotion(const TetMesh &mesh);

    /// Returns P d.
    template <typename Number>
    NodalVectors<Number> of(const NodalVectors<Number> &d) const;

    /// Returns P^T y.
    NodalVectors<double> transpose(NodalVectors<double> y) const;

  private:
    /// Nodes off the surface that lie on as many planes of symmetry. Their motions follow from those of the surface and of
    /// nodes on more planes:  A r = sum of those of the neighbours.
    struct Level
    {
      std::vector<NodeIndex>              nodes;
      std::vector<std::vector<NodeIndex>> known;   ///< neighbours of each that do not belong to the level
      dealii::SparseDirectUMFPACK         inverse; ///< of A

      /// Solves A x = b for each component.
      std::vector<Vec3> solve(const std::vector<Vec3> &b) const;
    };

    void make_surface(const TetMesh &mesh);
    void make_levels(const TetMesh &mesh);

    NodalVectors<double> continued(NodalVectors<double> r) const;

    std::vector<std::vector<Vec3>>         normals_; ///< of the planes of symmetry at each node, orthonormal
    std::vector<std::vector<unsigned int>> planes_;  ///< their patches
    std::vector<char>                      on_surface_;
    std::vector<dealii::Tensor<2, 3>>      across_; ///< what P is at nodes of the surface
    std::vector<std::unique_ptr<Level>>    levels_; ///< those on most planes first
  };
} // namespace retroforge
