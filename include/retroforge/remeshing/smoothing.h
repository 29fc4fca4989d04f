// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/remeshing/remeshing_context.h>

namespace retroforge
{
  /// Return the faces seen from a node, and those that the middle of an edge would see.
  Cavity cavity_of_node(const EditableMesh &mesh, NodeIndex node);
  Cavity cavity_of_edge(const EditableMesh &mesh, NodeIndex a, NodeIndex b);

  struct BestPosition
  {
    Vec3                    x;
    double                  quality;
    unsigned int            axis;  ///< by which directions were found
    std::vector<SearchStep> steps; ///< on the way there
  };

  /// Returns the directions of a search inside.
  std::vector<Vec3> space_directions();

  /// Returns the parts of the two directions u and v across the normal that direction i of a search on the surface is.
  std::array<double, 2> plane_direction(unsigned int i);

  /// Part of the size of a cavity by which a node on a ridge is pushed to find the direction of the ridge.
  constexpr double ridge_push = 0.1;

  /// Raises the smallest quality of a cavity by moving its apex from `start`, which is in its place: compass
  /// search in the directions the place allows (all, tangential, along the curve), with the step halved from
  /// a quarter of the size of the cavity down to a hundredth of the size. The quality is not smooth, so that
  /// gradients would not help.
  BestPosition
  best_position(const EditableMesh &mesh, const Cavity &cavity, const Place &place, const Vec3 &start);

  /// Returns how the best position was found.
  /// @param between  see Placement
  Placement
  searched(const std::array<NodeIndex, 2> &between, const Place &place, Cavity cavity, BestPosition best);

  /// Moves a node to its best position, when that raises the smallest quality of its star by more than
  /// `least_gain` and its boundary faces look the same way as before. Corners stay.
  std::optional<CavityChange>
  plan_smoothing(const RemeshingContext &context, NodeIndex node, double least_gain);
} // namespace retroforge
