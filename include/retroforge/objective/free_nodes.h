// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/final_objective.h>

namespace retroforge
{
  /// The degree to which nodes of the workpiece are free of all dies at the end, 0 to 1:
  ///   f_k = product over dies d of 1 - w(delta_kd),
  /// w the friction ramp of contact: 0 where a node touches, 1 where it is out of the ramp's width. A node
  /// that an edge holds off a curved die touches, as it does for friction. Frozen: which points are within
  /// the ramp's width, and the features of the dies that they see.
  class FreeNodes
  {
  public:
    explicit FreeNodes(const FrictionRamp &ramp) : ramp_(ramp) {}

    /// The points within the ramp's width, and what they see.
    using Decisions = std::vector<ContactPair>;
    Decisions decide(const FinalView<double> &view) const;

    /// Returns f of every node.
    template <typename Number>
    std::vector<Number> parts(const FinalView<Number> &view, const Decisions &near) const;

    /// Adds the derivatives of  parts_bar·parts  in positions, and in displacements and vertices of the dies.
    void reverse(const FinalView<double>   &view,
                 const Decisions           &near,
                 const std::vector<double> &parts_bar,
                 FinalBar                  &bar) const;

  private:
    FrictionRamp ramp_;
  };
} // namespace retroforge
