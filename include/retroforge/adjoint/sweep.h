// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/time/objective_trace.h>

namespace retroforge
{
  /// A recorded run, to be differentiated. What is referred to must live as long.
  struct RecordedForging
  {
    const ForgingModel        &model;
    std::shared_ptr<MeshEpoch> first; ///< the epoch in which the run began
    const Process<double>     &process;
    Forging::RecordAccess      record;
    unsigned int               n; ///< increments
    const Objectives          &objectives;
    const RecordedObjectives  &traced; ///< of these; they have decided
    Timings                   &timings;
    /// Of each increment, where ends follow the state (steps/moved_ends.h); else none.
    std::vector<FollowingRule> rules = {};
    NodalVectors<double>       X_0   = {}; ///< where the run began, if so [mm]
    bool meshes_follow = false;            ///< whether new meshes follow the shape (steps/following_mesh.h)
    /// Of each increment, as `rules`, of combinations that are said to be late; none: their ends are held.
    std::vector<FollowingRule> late_rules = {};
  };

  /// dPhi/dX_0 and dPhi/d(process) of one combination of objectives.
  struct AdjointResult
  {
    NodalVectors<double> X_0;
    Process<double>      process;
  };

  struct AdjointSweep
  {
    std::vector<AdjointResult> gradients; ///< of each combination
    unsigned int               linear_solves = 0;
  };

  /// The backward sweep over all recorded increments: per combination one linear solve per stage, J^T at each
  /// remeshing. Two meshes are in memory while one is left for the other.
  /// @param end   where it ended; earlier positions and strains follow from the recorded velocities
  /// @param late  which combinations have the late rules; empty: none
  AdjointSweep adjoint_sweep(const RecordedForging          &run,
                             const ForgingState             &end,
                             const std::vector<Combination> &combinations,
                             const std::vector<bool>        &late = {});

  /// The direct method: all objectives and their derivatives along one direction of (X_0, process), by the
  /// same kernels run forward on dual numbers.
  std::vector<Dual>
  tangent_sweep(const RecordedForging &run, const Process<Dual> &process, NodalVectors<Dual> X_0);
} // namespace retroforge
