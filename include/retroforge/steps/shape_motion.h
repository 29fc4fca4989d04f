// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/tet_mesh.h>

#include <deal.II/lac/sparse_direct.h>
#include <deal.II/lac/vector.h>

#include <memory>

namespace retroforge
{
  /// P, the part of a motion d of a mesh's nodes that changes its shape. A linear map, of the mesh where it was made:
  /// - on the surface it is d but in the directions t in which a node may slide: those of the eigenvectors of
  ///   sum_f A_f n_f n_f^T  over the faces around that have small eigenvalues, perpendicular to the sum of their area vectors,
  ///   so that the volume changes as by d. Two on faces, one along a sharp edge, none at a corner;
  ///   where patches meet, only the one along their border, and none at its ends and corners. Along them nodes slide so
  ///   that neighbours on the surface move as alike as can be:  sum over faces of |P d_a - P d_b|^2 of their edges  is least.
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

    /// Directions in which the nodes of the surface slide. Their motions along them follow from
    ///   A x = T^T S K d,    P d = K d + T x,
    /// T the directions, K = 1 - T T^T, S sums over the neighbours, each as often as there are faces.
    struct Sliding
    {
      std::vector<std::vector<Vec3>>                         directions; ///< of each node, orthonormal
      std::vector<unsigned int>                              first;      ///< unknown of each node
      std::vector<std::vector<std::pair<NodeIndex, double>>> beside;     ///< neighbours, number of faces
      unsigned int                                           n = 0;      ///< unknowns
      dealii::SparseDirectUMFPACK                            inverse;    ///< of A

      /// Returns A^-1 T^T y.
      dealii::Vector<double> solve(const NodalVectors<double> &y) const;
      /// Returns T x.
      NodalVectors<double> along(const dealii::Vector<double> &x) const;
      /// Returns S y.
      NodalVectors<double> around(const NodalVectors<double> &y) const;
      /// Returns K y.
      NodalVectors<double> held(NodalVectors<double> y) const;
    };

    void make_surface(const TetMesh &mesh);
    void make_sliding(const TetMesh &mesh);
    void make_levels(const TetMesh &mesh);

    NodalVectors<double> continued(NodalVectors<double> r) const;

    std::vector<std::vector<Vec3>>         normals_; ///< of the planes of symmetry at each node, orthonormal
    std::vector<std::vector<unsigned int>> planes_;  ///< their patches
    std::vector<char>                      on_surface_;
    Sliding                                sliding_;
    std::vector<std::unique_ptr<Level>>    levels_; ///< those on most planes first
  };
} // namespace retroforge
