// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/vector_algebra.h>

#include <vector>

namespace retroforge
{
  /// x -> slide + turn x x, scaled so that the nodes' mean square motion is 1.
  struct RigidMotion
  {
    Vec3 slide; ///< dimensionless
    Vec3 turn;  ///< [1/mm]

    template <typename Number>
    Vector3<Number> at(const Vector3<Number> &x) const
    {
      Vector3<Number> motion;
      for (unsigned int i = 0; i < 3; ++i)
        motion[i] = slide[i] + turn[(i + 1) % 3] * x[(i + 2) % 3] - turn[(i + 2) % 3] * x[(i + 1) % 3];
      return motion;
    }
  };

  /// What holds a workpiece that dies touch along lines or at points only: a drag on its mean velocities along
  /// the rigid motions m_j that these do not resist. The force on node k of n is
  ///   f_k = sum_j c_h g_j m_j(X_k)/n,   g_j = 1/n sum_k m_j(X_k)·V_k.
  /// It has a potential, and vanishes where the workpiece does not move that way. Motions and c_h are
  /// recorded with the increment, and frozen in the reverse sweep; X_k is not.
  struct RigidHold
  {
    double                   drag = 0.; ///< c_h [N s/mm]
    std::vector<RigidMotion> motions;

    bool empty() const { return motions.empty(); }
  };

  /// What a hold bears.
  struct HoldLoad
  {
    Vec3 force;  ///< [N]
    Vec3 moment; ///< about the nodes' centre [N mm]
  };
} // namespace retroforge
