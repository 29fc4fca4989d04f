// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/equilibrium.h>

namespace retroforge
{
  /// The axes a node's velocity is solved in: first the directions that are fixed, then those in which dies
  /// push. Equilibrium is tested along them, too, but where friction follows the normal force: there the rows
  /// along the die take so much of the row of its normal that the penalty stays in this one alone.
  struct NodeFrame
  {
    dealii::Tensor<2, 3> axes;  ///< orthonormal rows: of velocities
    dealii::Tensor<2, 3> tests; ///< rows, of the determinant of the axes: of momentum
    unsigned int         n_fixed  = 0;
    bool                 identity = true; ///< both are

    Vec3 to_frame(const Vec3 &v) const { return identity ? v : axes * v; }
    Vec3 to_space(const Vec3 &v) const { return identity ? v : v * axes; }
    Vec3 to_tests(const Vec3 &v) const { return identity ? v : tests * v; }
    /// The transpose of to_tests().
    Vec3 from_tests(const Vec3 &v) const { return identity ? v : v * tests; }
  };

  /// Makes the tests of a node's momentum for a contact tangent T in the frame: with p the free axis of its
  /// largest diagonal entry, row i takes  (T_ip - T_pi) / T_pp  times row p off. What is left couples the two
  /// alike in both directions.
  void choose_tests(const dealii::Tensor<2, 3> &tangent, NodeFrame &frame);

  /// Frames of the nodes of Discretization::condensed_nodes(), by place: symmetry planes fix their normals, a
  /// die's normal becomes an axis of its own, so that the penalty stands on one diagonal entry whatever the
  /// die's orientation. Between two dies the first axis is that of the one which holds.
  /// @param active  contacts that hold
  std::vector<NodeFrame>
  make_frames(const Scene &scene, const ContactSet<double> &contact, const ActiveSet &active);
} // namespace retroforge
