// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/remeshing/remeshing_context.h>

namespace retroforge
{
  /// Faces seen from one point: with it as fourth corner each makes a positively oriented cell.
  using Cavity = std::vector<std::array<NodeIndex, 3>>;

  /// Return the faces seen from a node, and those that the middle of an edge would see.
  Cavity cavity_of_node(const EditableMesh &mesh, NodeIndex node);
  Cavity cavity_of_edge(const EditableMesh &mesh, NodeIndex a, NodeIndex b);

  struct BestPosition
  {
    Vec3   x;
    double quality;
  };

  /// Raises the smallest quality of a cavity by moving its apex from `start`, which is in its place: compass
  /// search in the directions the place allows (all, tangential, along the curve), with the step halved from
  /// a quarter of the size of the cavity down to a hundredth of the size. The quality is not smooth, so that
  /// gradients would not help.
  BestPosition
  best_position(const EditableMesh &mesh, const Cavity &cavity, const Place &place, const Vec3 &start);

  /// Moves a node to its best position, when that raises the smallest quality of its star by more than
  /// `least_gain` and its boundary faces look the same way as before. Corners stay.
  std::optional<CavityChange>
  plan_smoothing(const RemeshingContext &context, NodeIndex node, double least_gain);
} // namespace retroforge
