// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/equilibrium.h>

namespace retroforge
{
  /// The axes a node's velocity is solved in: first the directions that are fixed, then those in which dies
  /// push. Equilibrium is tested along them, too, but where friction follows the normal force: there the rows
  /// along the die take so much of the row of its normal that the penalty stays in this one alone.
  template <int dim>
  struct VelocityFrame
  {
    using Vector = dealii::Tensor<1, dim>;

    dealii::Tensor<2, dim> axes;  ///< orthonormal rows: of velocities
    dealii::Tensor<2, dim> tests; ///< rows, of the determinant of the axes: of momentum
    unsigned int           n_fixed  = 0;
    bool                   identity = true; ///< both are

    Vector to_frame(const Vector &v) const { return identity ? v : axes * v; }
    Vector to_space(const Vector &v) const { return identity ? v : v * axes; }
    Vector to_tests(const Vector &v) const { return identity ? v : tests * v; }
    /// The transpose of to_tests().
    Vector from_tests(const Vector &v) const { return identity ? v : v * tests; }
  };

  using NodeFrame = VelocityFrame<3>;

  /// Appends a direction to the first n axes, orthonormalised against them, unless it lies nearly in their
  /// span.
  /// @return how many axes there are
  template <int dim>
  unsigned int append_axis(dealii::Tensor<2, dim> &axes, unsigned int n, dealii::Tensor<1, dim> direction);

  /// Completes n axes to an orthonormal basis.
  template <int dim>
  void complete_axes(dealii::Tensor<2, dim> &axes, unsigned int n);

  /// Makes the tests of a node's momentum for a contact tangent T in the frame: with p the free axis of its
  /// largest diagonal entry, row i takes  (T_ip - T_pi) / T_pp  times row p off. What is left couples the two
  /// alike in both directions.
  template <int dim>
  void choose_tests(const dealii::Tensor<2, dim> &tangent, VelocityFrame<dim> &frame);

  /// Frames of the nodes of Discretization::condensed_nodes(), by place: symmetry planes fix their normals, a
  /// die's normal becomes an axis of its own, so that the penalty stands on one diagonal entry whatever the
  /// die's orientation. Between two dies the first axis is that of the one which holds.
  /// @param active  contacts that hold
  std::vector<NodeFrame>
  make_frames(const Scene &scene, const ContactSet<double> &contact, const ActiveSet &active);
} // namespace retroforge
