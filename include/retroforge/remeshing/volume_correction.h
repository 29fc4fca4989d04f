// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/tet_mesh.h>
#include <retroforge/remeshing/remeshing_parameters.h>

#include <array>

namespace retroforge
{
  /// What a node must not leave: symmetry planes and flat pieces of the surface.
  struct NodeConstraint
  {
    std::array<Vec3, 3>         directions; ///< orthonormal
    std::array<Vec3, 3>         normals;    ///< that span the same
    std::array<unsigned int, 3> faces;      ///< whose normals these are; invalid_index: a symmetry plane's
    unsigned int                n = 0;

    /// Returns the part of a vector along which the node may move.
    Vec3 project(Vec3 v) const;

    /// Unless it is nearly the same as what there is.
    void add(const Vec3 &normal, unsigned int face);
  };

  /// How a volume was corrected.
  struct VolumeCorrection
  {
    double                      distance = 0.; ///< d [mm]; no node moved farther
    double                      rest     = 0.; ///< of the wanted volume, what is still missing [mm^3]
    NodalVectors<double>        directions;    ///< u; empty where no surface can move
    std::vector<NodeConstraint> constraints;   ///< of each node
  };

  /// Returns dV/dX_k of each node: a third of the area vectors of the faces at it [mm^2].
  NodalVectors<double> volume_gradient(const std::vector<BoundaryFace> &faces, const NodalVectors<double> &X);

  /// Gives a mesh a wanted volume by moving the nodes of its curved surface, all by the same distance along
  /// the outward normal: spread so thinly it stays invisible, where correcting only touched nodes would make
  /// bumps.
  ///
  /// Newton's method on the distance d,  V(X + d u) = V0,  u_k = P_k g_k / |g_k|  with the area vector g_k =
  /// dV/dX_k. P_k takes out the normals of the symmetry planes and of the flat faces at k: what is flat (on a
  /// flat die, say) stays flat, and its rim moves inside it. When nothing is curved, flat faces move too.
  /// Errors of rounding (1e-13 of the volume; 1e-12 when nothing is curved) are left alone.
  /// A step that would leave a cell less than a fifth of its volume is halved until none does, and the rest
  /// of the error stays.
  /// @param held         nodes that must not move
  /// @param ridge_angle  faces of one patch that turn by more bound a flat piece [degrees]
  VolumeCorrection
  correct_volume(TetMesh &mesh, double wanted_volume, const std::vector<bool> &held, double ridge_angle);
} // namespace retroforge
