// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/stage.h>

namespace retroforge
{
  /// The axes a node's velocity is solved in: first the directions that are fixed, then those in which dies
  /// push.
  struct NodeFrame
  {
    dealii::Tensor<2, 3> axes; ///< orthonormal rows
    unsigned int         n_fixed  = 0;
    bool                 identity = true;

    Vec3 to_frame(const Vec3 &v) const { return identity ? v : axes * v; }
    Vec3 to_space(const Vec3 &v) const { return identity ? v : v * axes; }
  };

  /// Frames of the nodes of Discretization::condensed_nodes(), by place: symmetry planes fix their normals, a
  /// die's normal becomes an axis of its own, so that the penalty stands on one diagonal entry whatever the
  /// die's orientation. Between two dies the first axis is that of the one which holds.
  /// @param active  contacts that hold
  std::vector<NodeFrame>
  make_frames(const Scene &scene, const ContactSet<double> &contact, const ActiveSet &active);
} // namespace retroforge
